#include "marey/core/ground_transform.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey {
namespace {

Recording one_step() {
  RecordingHeader header;
  header.name = "match";
  header.frame.kind = FrameOfReference::Kind::ground;
  header.rate_hz = 25;
  Recording recording(header);
  Instant instant;
  instant.index = 4;
  instant.time = timestamp_from_seconds(0.16);
  instant.named = {{TrackId{2}, "9", "blue"}};
  Sample& sample = instant.samples.emplace_back();
  sample.track = TrackId{2};
  sample.position = {3, 1, 0};
  sample.velocity = Vector<3>(2, 1, 0);
  sample.covariance = (Matrix<3>() << 4, 1, 0, 1, 9, 0, 0, 0, 0).finished();
  sample.provenance = Provenance::filled;
  sample.cameras = 5;
  instant.samples.emplace_back().track = TrackId{6};
  recording.add(instant);
  return recording;
}

TEST(OtherGround, PlacesVelocitiesAndCovariancesAreTurned) {
  Matrix<2> quarter;
  quarter << 0, -1, 1, 0;
  const FrameOfReference user{FrameOfReference::Kind::user_ground, {}};
  const Recording before = one_step();
  const Recording after = on_other_ground(
      before, user, {[&](const Vector<2>& location) { return Vector<2>(quarter * location + Vector<2>(10, 0)); }, quarter});
  EXPECT_EQ(after.header.frame, user);
  EXPECT_EQ(after.header.rate_hz, 25);
  ASSERT_EQ(after.tracks().size(), 2u);
  const Sample sample = after.find(TrackId{2})->sample(0);
  EXPECT_EQ(sample.position, Vector<3>(9, 3, 0));
  EXPECT_EQ(sample.velocity, Vector<3>(-1, 2, 0));
  EXPECT_EQ(sample.covariance, (Matrix<3>() << 9, -1, 0, -1, 4, 0, 0, 0, 0).finished());
  EXPECT_EQ(sample.provenance, Provenance::filled);
  EXPECT_EQ(sample.cameras, 5u);
  EXPECT_EQ(after.find(TrackId{2})->name.label, "9");
  EXPECT_FALSE(after.find(TrackId{6})->velocity(0)) << "what is not known stays so";
  ASSERT_EQ(after.instants().size(), 1u);
  EXPECT_EQ(after.instants()[0].index, 4);
  EXPECT_EQ(before.find(TrackId{2})->location(0), Vector<2>(3, 1)) << "the one that was given is as it was";
}

TEST(OtherGround, OnlyTheGroundHasAnother) {
  for (const auto kind : {FrameOfReference::Kind::image, FrameOfReference::Kind::space}) {
    RecordingHeader header;
    header.frame.kind = kind;
    EXPECT_THROW(on_other_ground(Recording(header), {FrameOfReference::Kind::user_ground, {}}, {}), Error);
  }
}

RecordingHeader user_header() {
  RecordingHeader header;
  header.frame.kind = FrameOfReference::Kind::user_ground;
  return header;
}

TEST(OtherGround, YGrowsDownWhereTheUsersFrameIsAReflection) {
  RecordingHeader header = user_header();
  EXPECT_FALSE(y_grows_down(header)) << "nothing is known";
  header.rig.emplace();
  EXPECT_FALSE(y_grows_down(header)) << "the user's frame is the world's";
  header.rig->ground_from_world = Matrix<3>{{0, -1, 3}, {-1, 0, 4}, {0, 0, 1}};
  EXPECT_TRUE(is_reflection(*header.rig->ground_from_world));
  EXPECT_TRUE(y_grows_down(header));
  header.frame.kind = FrameOfReference::Kind::ground;
  EXPECT_FALSE(y_grows_down(header)) << "the world is right-handed";
  header.rig->ground_from_world = Matrix<3>{{0, -1, 3}, {1, 0, 4}, {0, 0, 1}};
  header.frame.kind = FrameOfReference::Kind::user_ground;
  EXPECT_FALSE(y_grows_down(header)) << "turned by a quarter";
}

TEST(OtherGround, KeepsFileGroundWithoutRig) {
  RecordingHeader header = user_header();
  set_y_down(header, true);
  EXPECT_TRUE(y_grows_down(header));
  set_y_down(header, false);
  EXPECT_TRUE(y_grows_down(header)) << "what is known stays";
  header = user_header();
  set_y_down(header, false);
  EXPECT_FALSE(y_grows_down(header));
}

}  // namespace
}  // namespace marey
