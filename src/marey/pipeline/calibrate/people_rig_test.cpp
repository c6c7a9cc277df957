#include "marey/calibrate/people/people_rig.h"

#include <cmath>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/simulate/room/room_keypoints.h"

namespace marey::pipeline::calibrate {
namespace {

using namespace marey::calibrate::people;

using marey::simulate::room::KeypointErrors;
using marey::simulate::room::RoomOptions;
using marey::simulate::room::RoomScene;

/// What a room's cameras see, and nothing of how they stand.
PeopleInput observations_of_room(const RoomScene& scene, const KeypointErrors& errors) {
  PeopleInput input;
  for (std::size_t c = 0; c < scene.rig().cameras.size(); ++c) {
    const RigCamera& camera = scene.rig().cameras[c];
    RigCamera& unknown = input.rig.cameras.emplace_back();
    unknown.name = camera.name, unknown.size = camera.size;
    input.cameras.push_back({keypoints_of_camera(scene, static_cast<int>(c), errors), scene.options().rate_hz});
  }
  return input;
}

RoomOptions room_of_walkers(int actors, double seconds) {
  RoomOptions options;
  options.cameras = 4;
  options.actors = actors;
  options.rate_hz = 25;
  options.frames = static_cast<std::int64_t>(25 * seconds);
  options.distorted = false;
  return options;
}

double distance_between(const Rig& rig, std::size_t a, std::size_t b) {
  return (rig.cameras[a].camera_from_world->inverse().translation - rig.cameras[b].camera_from_world->inverse().translation).norm();
}

struct RigErrors {
  double distance = 0;  ///< relative, the worst of those between cameras but the first two
  double rotation = 0;  ///< rad, of a camera against the first, the worst
  double focal = 0;     ///< relative, the worst
  double offset_s = 0;  ///< against the first camera's, the worst
};

RigErrors rig_errors(const Rig& found, const Rig& truth) {
  RigErrors errors;
  for (std::size_t a = 0; a < truth.cameras.size(); ++a) {
    for (std::size_t b = a + 1; b < truth.cameras.size(); ++b)
      errors.distance = std::max(errors.distance, std::abs(distance_between(found, a, b) / distance_between(truth, a, b) - 1));
    const auto turn = [&](const Rig& rig) {
      return Matrix<3>(rig.cameras[a].camera_from_world->rotation * rig.cameras[0].camera_from_world->rotation.transpose());
    };
    const Matrix<3> off = turn(found) * turn(truth).transpose();
    errors.rotation = std::max(errors.rotation, std::acos(std::clamp((off.trace() - 1) / 2, -1.0, 1.0)));
    const double focal = geometry::focal_of(*found.cameras[a].lens).x() / geometry::focal_of(*truth.cameras[a].lens).x();
    errors.focal = std::max(errors.focal, std::abs(focal - 1));
    const auto offset = [&](const Rig& rig) { return rig.cameras[a].offset_s.value_or(0) - rig.cameras[0].offset_s.value_or(0); };
    errors.offset_s = std::max(errors.offset_s, std::abs(offset(found) - offset(truth)));
  }
  return errors;
}

PeopleOptions with_distance(const Rig& truth) {
  PeopleOptions options;
  options.distance =
      marey::calibrate::wand::KnownDistance{truth.cameras[0].name, truth.cameras[1].name, distance_between(truth, 0, 1)};
  return options;
}

TEST(PeopleRig, StatedFocalLengthsHelpTwoCameras) {
  RoomOptions room = room_of_walkers(1, 20);
  room.cameras = 2;
  const RoomScene scene(room);
  KeypointErrors errors;
  PeopleInput input = observations_of_room(scene, errors);
  const double without = rig_errors(calibrate_people(input, with_distance(scene.rig())).rig, scene.rig()).focal;
  // As of phones whose videos are cropped a little.
  for (std::size_t c = 0; c < 2; ++c) input.cameras[c].focal_px = 0.97 * geometry::focal_of(*scene.rig().cameras[c].lens).x();
  const double with = rig_errors(calibrate_people(input, with_distance(scene.rig())).rig, scene.rig()).focal;
  EXPECT_LT(with, 0.05) << "without: " << without;
  EXPECT_LT(with, without);
}

TEST(PeopleRig, CalibratesFourCamerasByOnePersonWhoWalks) {
  const RoomScene scene(room_of_walkers(1, 15));
  const PeopleRig found = calibrate_people(observations_of_room(scene, {}), with_distance(scene.rig()));
  EXPECT_EQ(found.people, 1);
  const RigErrors errors = rig_errors(found.rig, scene.rig());
  EXPECT_LT(errors.distance, 0.02);
  EXPECT_LT(errors.rotation, 0.02);
  EXPECT_LT(errors.focal, 0.03);
  EXPECT_NEAR(found.height, 1.75, 0.15);
  for (std::size_t c = 0; c < 4; ++c) {
    const double height = found.rig.cameras[c].camera_from_world->inverse().translation.z();
    EXPECT_NEAR(height, scene.rig().cameras[c].camera_from_world->inverse().translation.z(), 0.25)
        << "above the floor, over which its walkers glide";
  }
}

TEST(PeopleRig, FindsWhenCamerasWereStarted) {
  RoomOptions options = room_of_walkers(1, 15);
  options.offset_s = 0.2;
  const RoomScene scene(options);
  const PeopleRig found = calibrate_people(observations_of_room(scene, {}), with_distance(scene.rig()));
  EXPECT_LT(rig_errors(found.rig, scene.rig()).offset_s, 0.5 / 25) << "half a frame";
}

TEST(PeopleRig, FindsHowFastClocksRunInALongRecording) {
  const RoomScene scene(room_of_walkers(1, 240));
  const KeypointErrors errors{.drift = 150e-6};
  PeopleOptions how = with_distance(scene.rig());
  how.max_offset_s = 0.04;
  const PeopleRig found = calibrate_people(observations_of_room(scene, errors), how);
  double largest = 0;
  for (std::size_t c = 1; c < 4; ++c) {
    const double truth = clock_drift(scene, static_cast<int>(c), errors);
    largest = std::max(largest, std::abs(truth));
    ASSERT_TRUE(found.rig.cameras[c].rate_hz);
    EXPECT_NEAR(25 / *found.rig.cameras[c].rate_hz - 1, truth, 40e-6) << "camera " << c;
  }
  EXPECT_GT(largest, 80e-6) << "the test is none without a drift";
  EXPECT_FALSE(found.rig.cameras[0].rate_hz) << "its clock is the rig's";
  EXPECT_LT(rig_errors(found.rig, scene.rig()).rotation, 0.02);
}

TEST(PeopleRig, KnowsPeopleApart) {
  const RoomScene scene(room_of_walkers(2, 12));
  const PeopleRig found = calibrate_people(observations_of_room(scene, {}), with_distance(scene.rig()));
  EXPECT_GE(found.people, 1);
  const RigErrors errors = rig_errors(found.rig, scene.rig());
  EXPECT_LT(errors.distance, 0.02);
  EXPECT_LT(errors.rotation, 0.02);
}

TEST(PeopleRig, StatesWhyThereIsNone) {
  const RoomScene scene(room_of_walkers(1, 4));
  PeopleInput input = observations_of_room(scene, {});
  input.cameras[1].sequence.frames.clear();
  EXPECT_THROW(calibrate_people(input), Error);
  input = observations_of_room(scene, {});
  input.rig.cameras[0].size.reset();
  EXPECT_THROW(calibrate_people(input), Error);
  input = observations_of_room(scene, {});
  for (auto& frame : input.cameras[2].sequence.frames) frame.clear();
  try {
    calibrate_people(input);
    FAIL() << "a camera that sees no person";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("cam3"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace marey::pipeline::calibrate
