#include "marey/track/offline/outline_log.h"

#include <csignal>
#include <filesystem>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "marey/core/error.h"

#include "support/files.h"

namespace marey::track::offline {
namespace {

/// Numbers that single precision holds exactly, so that the numbers read must equal those written.
Track<2> track_with_outline(int id, int seed) {
  auto outline = std::make_shared<Outline>();
  outline->order = 3;
  outline->state = seed % 2 == 0 ? Outline::State::held : Outline::State::partly;
  outline->centre = {100.25 + seed, 7.5};
  outline->velocity = {-3.5, seed * 0.5};
  outline->scale_rate = 0.125;
  outline->centre_deviation = {0.5, 0.25};
  outline->velocity_deviation = {2, 4};
  outline->scale_rate_deviation = 0.0625;
  if (seed % 2 == 0) outline->silhouette = Vector<2>(seed, 0.5);
  for (int i = 0; i < 5 + seed % 3; ++i) {
    outline->control_points.emplace_back(10.0 * i, seed + 0.75);
    outline->deviations.emplace_back(0.5 * i, 1.5);
  }
  for (int i = 0; i < seed % 4; ++i) {
    outline->lines.push_back({.foot = {1.5 * i, 2},
                              .normal = {0, -1},
                              .reach = 6,
                              .finding = MeasurementLine::Finding::outlier,
                              .offset = -1.25,
                              .variance = 0.75});
  }
  Track<2> track;
  track.id = TrackId{id};
  track.outline = outline;
  return track;
}

void expect_equal(const Outline& a, const Outline& b, bool with_lines) {
  EXPECT_EQ(a.order, b.order);
  EXPECT_EQ(a.state, b.state);
  EXPECT_EQ(a.centre, b.centre);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.scale_rate, b.scale_rate);
  EXPECT_EQ(a.centre_deviation, b.centre_deviation);
  EXPECT_EQ(a.velocity_deviation, b.velocity_deviation);
  EXPECT_EQ(a.scale_rate_deviation, b.scale_rate_deviation);
  EXPECT_EQ(a.silhouette, b.silhouette);
  EXPECT_EQ(a.control_points, b.control_points);
  EXPECT_EQ(a.deviations, b.deviations);
  ASSERT_EQ(with_lines ? a.lines.size() : 0, b.lines.size());
  for (std::size_t i = 0; i < b.lines.size(); ++i) {
    EXPECT_EQ(a.lines[i].foot, b.lines[i].foot);
    EXPECT_EQ(a.lines[i].normal, b.lines[i].normal);
    EXPECT_EQ(a.lines[i].reach, b.lines[i].reach);
    EXPECT_EQ(a.lines[i].finding, b.lines[i].finding);
    EXPECT_EQ(a.lines[i].offset, b.lines[i].offset);
    EXPECT_EQ(a.lines[i].variance, b.lines[i].variance);
  }
}

TEST(OutlineLog, GivesBackWhatItWasGiven) {
  for (const bool with_lines : {false, true}) {
    const test::TemporaryFolder folder;
    OutlineLog recording(folder / "tracks.jsonl", with_lines);
    for (int frame = 0; frame < 40; ++frame) {
      std::vector<Track<2>> tracks;
      for (int id = 1; id <= frame % 4; ++id) tracks.push_back(track_with_outline(id, frame + id));
      tracks.emplace_back().id = TrackId{9};  // without an outline
      recording.add(frame, tracks);
    }
    for (int pass = 0; pass < 2; ++pass) {
      for (int frame = pass; frame < 45; frame += 1 + pass) {
        const auto& outlines = recording.at(frame);
        ASSERT_EQ(outlines.size(), frame < 40 ? static_cast<std::size_t>(frame % 4) : 0u);
        for (const auto& [id, outline] : outlines) expect_equal(*track_with_outline(id, frame + id).outline, *outline, with_lines);
      }
    }
  }
}

TEST(OutlineLog, LeavesNothingInTheFolderAndTakesADeviceForNone) {
  const test::TemporaryFolder folder;
  {
    OutlineLog recording(folder / "tracks.jsonl", false);
    const std::vector tracks{track_with_outline(1, 1)};
    recording.add(0, tracks);
    EXPECT_EQ(recording.at(0).size(), 1u);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  }
  EXPECT_NO_THROW(OutlineLog("/dev/stdout", false));
}

/// What the file's buffer still held when the disk was full.
TEST(OutlineLog, ADiskThatIsFullIsSaidWhenReadingBegins) {
  const test::TemporaryFolder folder;
  OutlineLog recording(folder / "tracks.jsonl", false);
  recording.add(0, std::vector{track_with_outline(1, 1)});
  const auto before = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit none{0, limit.rlim_max};
  setrlimit(RLIMIT_FSIZE, &none);
  std::string stated;
  try {
    recording.at(0);
  } catch (const Error& error) {
    stated = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, before);
  EXPECT_NE(stated.find("no room beside it"), std::string::npos) << stated;
}

}  // namespace
}  // namespace marey::track::offline
