#include "marey/core/recording.h"

#include <map>
#include <memory>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/core/recording_reader.h"

namespace marey {
namespace {

RecordingHeader header_in(FrameOfReference::Kind kind) {
  RecordingHeader header;
  header.name = "test";
  header.frame.kind = kind;
  header.rate_hz = 50;
  return header;
}

Sample sample_of(int track, double x) {
  Sample sample;
  sample.track = TrackId{track};
  sample.position = {x, 2 * x, 0};
  return sample;
}

void expect_same(const Instant& is, const Instant& was) {
  EXPECT_EQ(is.index, was.index);
  EXPECT_EQ(is.time, was.time);
  EXPECT_EQ(is.detected, was.detected);
  ASSERT_EQ(is.samples.size(), was.samples.size()) << was.index;
  for (std::size_t i = 0; i < was.samples.size(); ++i) {
    const Sample &a = is.samples[i], &b = was.samples[i];
    EXPECT_EQ(a.track, b.track);
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.velocity, b.velocity);
    EXPECT_EQ(a.covariance, b.covariance);
    EXPECT_EQ(a.box, b.box);
    EXPECT_EQ(a.outline, b.outline);
    EXPECT_EQ(a.residual_px, b.residual_px);
    EXPECT_EQ(a.residual_m, b.residual_m);
    EXPECT_EQ(a.provenance, b.provenance);
    EXPECT_EQ(a.cameras, b.cameras);
  }
}

TEST(Recording, GivesBackWhatWasPutIn) {
  Recording recording(header_in(FrameOfReference::Kind::space));
  std::vector<Instant> given;
  for (int i = 0; i < 20; ++i) {
    Instant instant;
    instant.index = 3 * i;
    instant.time = timestamp_from_seconds(0.06 * i);
    if (i == 0) instant.named = {{TrackId{2}, "LKNE", "blue"}};
    for (int track = 1; track <= 3; ++track) {
      if ((i + track) % 4 == 0 || (i == 0 && track == 3)) continue;
      Sample sample = sample_of(track, i + 0.25 * track);
      sample.position.z() = -i;
      if (i % 3 == 1) sample.velocity = Vector<3>(1, i, track);
      if (i % 5 == 2) sample.covariance = (Matrix<3>() << 4, 1, 0.5, 1, 5, 0.25, 0.5, 0.25, 6).finished() * (i + 1);
      if (i % 4 == 3) sample.box = Box{1, 2, 3, static_cast<double>(i)};
      if (i == 7) sample.outline = std::make_shared<Outline>();
      if (i > 10) sample.residual_px = 0.1 * i;
      sample.provenance = i % 6 == 5 ? Provenance::filled : Provenance::measured;
      sample.cameras = static_cast<CameraMask>(i);
      instant.samples.push_back(sample);
    }
    if (i > 4) instant.detected.push_back({CameraId{1}, {i + 0.5, 2}, 0.1, {}, TrackId{1}});
    given.push_back(instant);
    recording.add(instant);
  }
  InstantsOf instants(recording);
  for (const Instant& was : given) {
    const auto is = instants.next();
    ASSERT_TRUE(is);
    expect_same(*is, was);
  }
  EXPECT_FALSE(instants.next());
  ASSERT_NE(recording.find(TrackId{2}), nullptr);
  EXPECT_EQ(recording.find(TrackId{2})->name.label, "LKNE");
  EXPECT_EQ(recording.find(TrackId{4}), nullptr);
}

TEST(Recording, TwoDimensionsHaveNoThirdColumn) {
  Recording recording(header_in(FrameOfReference::Kind::ground));
  Instant instant;
  instant.samples = {sample_of(1, 4)};
  instant.samples[0].covariance = Matrix<3>(Vector<3>(1, 2, 0).asDiagonal());
  recording.add(instant);
  const TrackColumns& track = recording.tracks().front();
  EXPECT_TRUE(track.z().empty());
  EXPECT_EQ(track.sample(0).covariance, instant.samples[0].covariance);
  EXPECT_FALSE(track.has_velocities());
}

TEST(Recording, KeepsTheKindOfATrackThatIsRenamed) {
  Recording recording(header_in(FrameOfReference::Kind::user_ground));
  recording.header.track_kind = TrackKind::person;
  Instant instant;
  instant.named = {{.id = TrackId{1}, .label = "ball", .team = {}},
                   {.id = TrackId{2}, .label = "b", .team = {}, .kind = TrackKind::ball}};
  instant.samples = {sample_of(1, 4), sample_of(2, 5), sample_of(3, 6)};
  instant.samples[1].position.z() = 2;
  recording.add(instant);
  recording.set_name({.id = TrackId{2}, .label = "the ball", .team = "red"});
  ASSERT_EQ(recording.tracks().size(), 3U);
  EXPECT_EQ(recording.tracks()[0].name.kind, TrackKind::person);  // a label is free text
  EXPECT_EQ(recording.tracks()[0].dimensions(), 2);
  EXPECT_EQ(recording.tracks()[1].name.kind, TrackKind::ball);
  EXPECT_EQ(recording.tracks()[1].position(0), Vector<3>(5, 10, 2));
  EXPECT_EQ(recording.tracks()[2].name.kind, TrackKind::person);
  recording.put(TrackColumns({.id = TrackId{4}, .label = {}, .team = {}}, 2));
  EXPECT_EQ(recording.find(TrackId{4})->name.kind, TrackKind::person);
  InstantsOf instants(recording);
  const auto again = instants.next();
  ASSERT_TRUE(again);
  ASSERT_EQ(again->named.size(), 2U);  // the third has the header's kind and no name
  EXPECT_EQ(again->named[1].kind, TrackKind::ball);
}

TEST(Recording, TimesFollowAnotherClock) {
  Recording recording(header_in(FrameOfReference::Kind::space));
  Instant instant;
  instant.time = timestamp_from_seconds(5);
  recording.add(instant);
  const TimeBase rig{.kind = TimeBase::Kind::rig}, second{.kind = TimeBase::Kind::camera, .camera = CameraId{1}};
  EXPECT_THROW(with_time_base(recording, second), Error);  // no rig
  recording.header.rig.emplace().cameras.resize(2);
  recording.header.rig->cameras[1].offset_s = 2.5;
  EXPECT_THROW(with_time_base(recording, second), Error);  // its own clock is not specified
  recording.header.time_base = rig;
  const Recording moved = with_time_base(recording, second);
  EXPECT_EQ(moved.header.time_base, second);
  EXPECT_EQ(moved.seconds_at(0), 2.5);
  EXPECT_EQ(with_time_base(moved, rig).seconds_at(0), 5);
  EXPECT_THROW(with_time_base(recording, {.kind = TimeBase::Kind::camera, .camera = CameraId{2}}), Error);
}

TEST(Recording, BodiesComeAndGo) {
  Recording recording(header_in(FrameOfReference::Kind::space));
  for (int i = 0; i < 6; ++i) {
    Instant instant;
    instant.index = 2 * i;
    for (const int body : {2, 5}) {
      if (body == 5 && i % 2 == 0) continue;
      BodyPose pose;
      pose.body = BodyId{body};
      pose.world_from_body.translation = {static_cast<double>(i), static_cast<double>(body), 0};
      pose.tracked = i != 3;
      if (i == 4) pose.covariance = Matrix<6>::Identity() * 2;
      if (i == 5) pose.residual_m = 0.5;
      instant.bodies.push_back(pose);
    }
    recording.add(instant);
  }
  ASSERT_EQ(recording.bodies().size(), 2U);
  EXPECT_EQ(recording.find(BodyId{5})->size(), 3U);
  EXPECT_EQ(recording.find(BodyId{3}), nullptr);
  EXPECT_EQ(recording.find(BodyId{5})->row_at(3), 1U);
  EXPECT_FALSE(recording.find(BodyId{5})->row_at(2));
  MemoryReader reader(recording);
  const Recording again = read_all(reader);
  InstantsOf instants(again);
  for (int i = 0; i < 6; ++i) {
    const auto instant = instants.next();
    ASSERT_TRUE(instant);
    ASSERT_EQ(instant->bodies.size(), i % 2 == 0 ? 1U : 2U);
    EXPECT_EQ(instant->bodies[0].world_from_body.translation.x(), i);
    EXPECT_EQ(instant->bodies[0].tracked, i != 3);
    EXPECT_EQ(instant->bodies[0].covariance.has_value(), i == 4);
    EXPECT_EQ(instant->bodies[0].residual_m, i == 5 ? std::optional(0.5) : std::nullopt);
  }
}

TEST(Recording, InstantsMustGrow) {
  Recording recording(header_in(FrameOfReference::Kind::ground));
  Instant instant;
  instant.index = 5;
  recording.add(instant);
  EXPECT_THROW(recording.add(instant), Error);
}

TEST(Recording, RateIsTheMedianStep) {
  std::vector<Recording::TimeStep> time_steps;
  for (int i = 0; i < 11; ++i) time_steps.push_back({i, timestamp_from_seconds(0.04 * i)});
  time_steps.push_back({999'999'999, timestamp_from_seconds(1)});
  EXPECT_NEAR(median_rate_hz(time_steps).value(), 25, 1e-6);
  EXPECT_FALSE(median_rate_hz(std::span(time_steps).first(1)));
}

TEST(Recording, RejectsPixelsIfMetresRequired) {
  const Recording image(header_in(FrameOfReference::Kind::image)), space(header_in(FrameOfReference::Kind::space));
  EXPECT_THROW(require_metric(image, "measuring"), Error);
  EXPECT_NO_THROW(require_metric(space, "measuring"));
  EXPECT_THROW(require_ground(space, "measuring"), Error);
}

/// Against a search for each track at each instant.
TEST(InstantRows, AreThoseThatAreThere) {
  Recording recording(header_in(FrameOfReference::Kind::user_ground));
  for (int i = 0; i < 200; ++i) {
    Instant instant;
    instant.index = i;
    for (int track = 1; track <= 20; ++track) {
      if (i >= 7 * track % 90 && i < 7 * track % 90 + 5 * track && (i * track) % 7 != 3)
        instant.samples.push_back(sample_of(track, i));
    }
    recording.add(instant);
  }
  recording.set_name({TrackId{30}, "never there", ""});
  for (const std::size_t step : {1, 3, 40}) {
    InstantRows rows(recording);
    for (std::size_t instant = 0; instant < 200; instant += step) {
      std::vector<std::pair<std::size_t, std::size_t>> found, required;
      for (const auto& [track, row] : rows.at(instant)) found.emplace_back(track, row);
      for (std::size_t t = 0; t < recording.tracks().size(); ++t) {
        if (const auto row = recording.tracks()[t].row_at(static_cast<std::int32_t>(instant))) required.emplace_back(t, *row);
      }
      EXPECT_EQ(found, required) << instant << " by " << step;
    }
  }
}

}  // namespace
}  // namespace marey
