#include "marey/reconstruct/keypoints/clock_offsets.h"

#include <cmath>

#include <gtest/gtest.h>

#include "marey/pipeline/keypoints/observed_room_test.h"

namespace marey::pipeline::keypoints {
namespace {

std::vector<rk::CameraFrames> clock_frames_of(const ObservedRoom& room) {
  std::vector<rk::CameraFrames> frames(room.cameras.size());
  for (std::size_t c = 0; c < frames.size(); ++c)
    frames[c] = {.camera = &*room.cameras[c], .people = &room.detected[c].frames, .rate_hz = room.scene.options().rate_hz};
  return frames;
}

TEST(ClockOffsets, AreFoundByMotionAndSayHowSureTheyAre) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    marey::simulate::room::RoomOptions options;
    options.motion = marey::simulate::room::RoomMotion::walk;
    options.cameras = 4;
    options.markers = 4;
    options.actors = seed == 3 ? 3 : 1;
    options.rate_hz = 50;
    options.frames = 300;
    options.image = {1080, 1920};
    options.zoom = 1.3;
    options.offset_s = 0.2;
    options.seed = seed;
    const ObservedRoom room(options, {});
    const auto found = rk::find_clock_offsets(clock_frames_of(room));
    EXPECT_FALSE(found[0]) << "the first one is what the others are against";
    for (std::size_t c = 1; c < 4; ++c) {
      ASSERT_TRUE(found[c]);
      const double error = found[c]->offset_s - *room.scene.rig().cameras[c].offset_s;
      EXPECT_LT(std::abs(error), 0.5 / options.rate_hz) << "seed " << seed << ", camera " << c + 1;
      EXPECT_LT(std::abs(error), 4 * found[c]->sigma_s + 0.1 / options.rate_hz);
      EXPECT_LT(found[c]->sigma_s, 0.5 / options.rate_hz);
    }
  }
}

TEST(ClockOffsets, AreNotSaidWhereNobodyMoves) {
  marey::simulate::room::RoomOptions options;
  options.motion = marey::simulate::room::RoomMotion::still;
  options.cameras = 3;
  options.markers = 4;
  options.rate_hz = 50;
  options.frames = 150;
  options.image = {1080, 1920};
  options.zoom = 1.3;
  const ObservedRoom room(options, {});
  for (const auto& offset : rk::find_clock_offsets(clock_frames_of(room))) EXPECT_FALSE(offset);
}

}  // namespace
}  // namespace marey::pipeline::keypoints
