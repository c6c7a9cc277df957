#include "marey/edit/fill_gap.h"

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/edit/decide.h"
#include "marey/edit/edited.h"
#include "marey/geometry/rigid.h"

namespace marey::edit {
namespace {

constexpr double kRate = 100;
constexpr int kFrames = 1200;

RecordingHeader header(const std::string& name) {
  RecordingHeader header;
  header.name = name;
  header.rate_hz = kRate;
  return header;
}

Instant instant_at(int frame) {
  Instant instant;
  instant.index = frame;
  instant.time = timestamp_from_seconds(0.01 * frame);
  return instant;
}

/// A body of five markers that swings and walks, and a sixth that hangs on it and swings by itself in time with a seventh.
Vector<3> position_of(int marker, int frame) {
  const double t = frame / kRate, swing = std::sin(2 * std::numbers::pi * 0.9 * t);
  const geometry::Rigid3 body{geometry::rotation_from({0.2 * swing, 0.3 * std::cos(t), 0.5 * swing}),
                              {1.2 * t, 0.05 * swing, 1 + 0.03 * std::sin(11 * t)}};
  static const std::vector<Vector<3>> kRigid{
      {0.1, 0, 0}, {-0.1, 0.02, 0.03}, {0, 0.12, 0.01}, {0.02, -0.1, 0.08}, {0.05, 0.04, -0.1}};
  if (marker < 5) return body * kRigid[static_cast<std::size_t>(marker)];
  const double own = 0.06 * std::sin(2 * std::numbers::pi * 0.9 * t + 0.4);
  return body * Vector<3>(marker == 5 ? 0.15 + own : 0.2 - 0.7 * own, marker == 5 ? 0.3 : 0.2, 0.5 * own);
}

Recording walk(double noise_m, unsigned seed, int frames = kFrames) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, noise_m);
  Recording recording(header("walk"));
  for (int marker = 0; marker < 7; ++marker)
    recording.set_name({.id = TrackId{marker + 1}, .label = fmt::format("M{}", marker), .team = {}});
  for (int frame = 0; frame < frames; ++frame) {
    Instant instant = instant_at(frame);
    for (int marker = 0; marker < 7; ++marker) {
      const Vector<3> off(noise(random), noise(random), noise(random));
      instant.samples.emplace_back();
      instant.samples.back().track = TrackId{marker + 1};
      instant.samples.back().position = position_of(marker, frame) + off;
    }
    recording.add(instant);
  }
  return recording;
}

Tracks tracks_of(const Recording& recording) {
  std::vector<TrackName> names;
  for (const TrackColumns& track : recording.tracks()) names.push_back(track.name);
  return Tracks(recording.instants(), names, [&recording](TrackId track) { return *recording.find(track); });
}

void cut(Tracks& tracks, int marker, int first, int last) {
  tracks.apply({.kind = Operation::Kind::remove, .tracks = {TrackId{marker + 1}}, .frames = FrameRange{first, last}});
}

/// Fills, applies, and returns how far each filled place is from the true one, with the deviation that was reported of it.
std::vector<std::pair<double, double>> errors(Tracks& tracks, int marker, const FillOptions& options,
                                              FillMethod* method = nullptr) {
  const auto fills = decide_fills(tracks, TrackId{marker + 1}, std::nullopt, options);
  if (fills.empty()) return {};
  if (method != nullptr) *method = fills.front().method;
  tracks.apply({.kind = Operation::Kind::fill, .gaps = fills});
  std::vector<std::pair<double, double>> all;
  for (const Tracks::Row& row : tracks.rows(TrackId{marker + 1})) {
    if (row.sample.provenance != Provenance::filled) continue;
    all.emplace_back((row.sample.position - position_of(marker, row.at)).norm(), std::sqrt(row.sample.covariance->trace()));
  }
  return all;
}

double rms(const std::vector<std::pair<double, double>>& errors) {
  double sum = 0;
  for (const auto& [error, deviation] : errors) sum += error * error;
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

TEST(FillGap, AShortGapIsFilledWithinTheNoise) {
  const Recording recording = walk(2e-4, 1);
  Tracks tracks = tracks_of(recording);
  cut(tracks, 2, 500, 508);
  const auto all = errors(tracks, 2, {});
  ASSERT_EQ(all.size(), 9u);
  EXPECT_LT(rms(all), 1e-3);
}

TEST(FillGap, ALongGapOfARigidMarkerIsCarriedByItsNeighbours) {
  const Recording recording = walk(2e-4, 2);
  Tracks tracks = tracks_of(recording), spline = tracks_of(recording);
  cut(tracks, 2, 500, 569);
  cut(spline, 2, 500, 569);
  FillMethod method{};
  const double carried = rms(errors(tracks, 2, {}, &method)),
               drawn = rms(errors(spline, 2, {.method = FillMethod::spline, .within_m = 10}));
  EXPECT_NE(method, FillMethod::spline);
  EXPECT_LT(carried, 1e-3);
  EXPECT_GT(drawn, 10 * carried) << "otherwise the scene shows nothing";
}

TEST(FillGap, AMarkerThatSwingsInTimeWithAnotherIsToldByIt) {
  const Recording recording = walk(2e-4, 3);
  Tracks tracks = tracks_of(recording), rigid = tracks_of(recording);
  cut(tracks, 5, 500, 569);
  cut(rigid, 5, 500, 569);
  FillMethod method{};
  const double reported = rms(errors(tracks, 5, {}, &method)),
               carried = rms(errors(rigid, 5, {.method = FillMethod::rigid, .within_m = 10}));
  EXPECT_EQ(method, FillMethod::pattern);
  EXPECT_LT(reported, 0.5 * carried);
}

TEST(FillGap, StatedErrorCoversTruth) {
  const unsigned seed = std::random_device()();
  SCOPED_TRACE(fmt::format("seed {}", seed));
  std::mt19937 random(seed);
  const Recording recording = walk(3e-4, seed);
  int covered = 0, count = 0;
  for (int trial = 0; trial < 30; ++trial) {
    Tracks tracks = tracks_of(recording);
    const int length = 10 + static_cast<int>(random() % 80), first = 300 + static_cast<int>(random() % 500),
              marker = static_cast<int>(random() % 7);
    cut(tracks, marker, first, first + length - 1);
    for (const auto& [error, deviation] : errors(tracks, marker, {})) {
      covered += error <= 2 * deviation;
      ++count;
    }
  }
  EXPECT_GT(covered, 0.65 * count);
}

/// There is no room for test holes as long as the gap; the remainder is seen for less than half of it on either side.
TEST(FillGap, ALongGapOfAShortTakeIsFilledWithTheErrorThatIsExpected) {
  const unsigned seed = std::random_device()();
  SCOPED_TRACE(fmt::format("seed {}", seed));
  const Recording recording = walk(3e-4, seed, 170);
  int covered = 0, count = 0;
  double squares = 0, expected = 0;
  for (int marker = 0; marker < 7; ++marker) {
    for (const int first : {30, 35, 40}) {
      Tracks tracks = tracks_of(recording);
      cut(tracks, marker, first, first + 99);
      const auto all = errors(tracks, marker, {});
      ASSERT_EQ(all.size(), 100u) << "marker " << marker;
      for (const auto& [error, deviation] : all) {
        covered += error <= 2 * deviation;
        squares += error * error;
        expected += deviation * deviation;
        ++count;
      }
    }
  }
  EXPECT_GT(covered, 0.7 * count);
  EXPECT_LT(expected, 10 * squares);
}

/// The same without any room before the gap: shorter holes behind it decide.
TEST(FillGap, ShorterHolesTellOfALongGapAtTheRim) {
  const Recording recording = walk(3e-4, 7, 170);
  Tracks tracks = tracks_of(recording);
  cut(tracks, 2, 1, 100);
  const auto fills = decide_fills(tracks, TrackId{3}, std::nullopt, {});
  ASSERT_EQ(fills.size(), 1u);
  EXPECT_LT(fills[0].expected_m, 0.01);
  EXPECT_GT(fills[0].expected_m, 1e-4);
}

TEST(FillGap, GapsThatStayOpenAreCounted) {
  const Recording recording = walk(3e-4, 8);
  Tracks tracks = tracks_of(recording);
  cut(tracks, 0, 200, 350);
  cut(tracks, 0, 500, 510);
  OpenGaps open;
  EXPECT_EQ(decide_fills(tracks, TrackId{1}, std::nullopt, {}, &open).size(), 1u);
  EXPECT_EQ(open.too_long, 1);
  EXPECT_TRUE(decide_fills(tracks, TrackId{1}, std::nullopt, {.longest_s = 1, .within_m = 1e-6}, &open).empty());
  EXPECT_EQ(open.too_far_off, 1);
  EXPECT_EQ(open.all(), 3);
}

TEST(FillGap, KeepsLongAndOpenEndedGaps) {
  const Recording recording = walk(1e-9, 4);
  Tracks tracks = tracks_of(recording);
  cut(tracks, 0, 0, 50);
  cut(tracks, 0, 1100, kFrames - 1);
  cut(tracks, 0, 400, 700);
  EXPECT_TRUE(errors(tracks, 0, {}).empty());
}

TEST(FillGap, ReplayingGivesTheSameBytesAndWithoutPlacesWhatIsGoneIsSaid) {
  Recording recording = walk(3e-4, 5);
  Tracks tracks = tracks_of(recording);
  cut(tracks, 5, 500, 569);
  const auto fills = decide_fills(tracks, TrackId{6}, std::nullopt, {});
  ASSERT_EQ(fills.size(), 1u);
  FilledGap bare = fills[0];
  bare.locations.clear();  // as takes of older versions have them
  const auto first = rows_in_gap(tracks, fills[0]), second = rows_in_gap(tracks, bare);
  ASSERT_EQ(first.size(), 70u);
  ASSERT_EQ(second.size(), 70u);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].sample.position, second[i].sample.position);
  cut(tracks, static_cast<int>(number(fills[0].donors[0])) - 1, 510, 512);
  const auto kept = rows_in_gap(tracks, fills[0]);
  ASSERT_EQ(kept.size(), 70u);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(kept[i].sample.position, first[i].sample.position);
  EXPECT_THROW(rows_in_gap(tracks, bare), Error);
}

TEST(FillGap, NeitherTwoMarkersNorALineOfThemTellsTooMuch) {
  Recording recording(header("line"));
  for (int marker = 1; marker <= 4; ++marker) recording.set_name({.id = TrackId{marker}, .label = {}, .team = {}});
  for (int frame = 0; frame < 300; ++frame) {
    Instant instant = instant_at(frame);
    for (int marker = 1; marker <= 4; ++marker) {
      instant.samples.emplace_back();
      instant.samples.back().track = TrackId{marker};
      instant.samples.back().position = Vector<3>(0.1 * marker, 0.01 * frame, 0);
    }
    recording.add(instant);
  }
  Tracks tracks = tracks_of(recording);
  cut(tracks, 0, 100, 130);
  FillMethod method{};
  const auto fills = decide_fills(tracks, TrackId{1}, std::nullopt, {});
  ASSERT_EQ(fills.size(), 1u);
  method = fills[0].method;
  EXPECT_EQ(method, FillMethod::spline);
}

}  // namespace
}  // namespace marey::edit
