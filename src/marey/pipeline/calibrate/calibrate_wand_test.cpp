// A wand, a light and an L-frame in simulated rooms, whose truth is known, and in two recorded sets.
#include <cmath>
#include <filesystem>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "marey/calibrate/ground.h"
#include "marey/calibrate/wand/wand.h"
#include "marey/core/error.h"
#include "marey/format/observations.h"
#include "marey/pipeline/calibrate/camera_blobs.h"
#include "marey/simulate/room/room.h"

#include "support/data.h"

namespace marey::pipeline::calibrate {
namespace {

marey::simulate::room::RoomOptions waved(int cameras, std::int64_t frames) {
  marey::simulate::room::RoomOptions room;
  room.motion = marey::simulate::room::RoomMotion::wand;
  room.cameras = cameras;
  room.frames = frames;
  return room;
}

/// What the cameras of a room saw, their lenses given or not, their poses and offsets never.
marey::calibrate::wand::WandInput input_of(const marey::simulate::room::RoomScene& scene, bool lenses = true) {
  marey::calibrate::wand::WandInput input;
  input.rig = scene.rig();
  input.wand.distances = scene.options().wand;
  for (RigCamera& camera : input.rig.cameras) {
    if (!lenses) camera.lens.reset();
    camera.camera_from_world.reset();
    camera.offset_s = 0;
  }
  input.detected.resize(input.rig.cameras.size());
  for (std::int64_t i = 0; i < scene.options().frames; ++i) {
    const marey::simulate::room::RoomFrame frame = scene.frame(i);
    for (std::size_t c = 0; c < frame.detected.size(); ++c) {
      marey::calibrate::wand::BlobFrame blobs{frame.time_s, {}};
      for (const marey::simulate::room::RoomBlob& blob : frame.detected[c]) blobs.blobs.push_back(blob.pixel);
      input.detected[c].push_back(std::move(blobs));
    }
  }
  return input;
}

struct Off {
  double centre_mm = 0;  // the worst camera's, after the rigs are laid onto each other
  double scale_percent = 0;
};

Eigen::Matrix3Xd centres_of(const Rig& rig) {
  Eigen::Matrix3Xd centres(3, rig.cameras.size());
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    centres.col(static_cast<Eigen::Index>(c)) = rig.cameras[c].camera_from_world->inverse().translation;
  }
  return centres;
}

Off compare(const Rig& found, const Rig& truth, bool free_scale = false) {
  const Eigen::Matrix3Xd a = centres_of(found), b = centres_of(truth);
  const Eigen::Matrix4d similar = Eigen::umeyama(a, b, true), motion = Eigen::umeyama(a, b, free_scale);
  Off off;
  off.scale_percent = 100 * (1 / std::cbrt(similar.topLeftCorner<3, 3>().determinant()) - 1);
  const Eigen::Matrix3Xd moved = (motion.topLeftCorner<3, 3>() * a).colwise() + Vector<3>(motion.topRightCorner<3, 1>());
  off.centre_mm = 1000 * (moved - b).colwise().norm().maxCoeff();
  return off;
}

/// The message with which it is refused; empty if it is not.
std::string refusal(const marey::calibrate::wand::WandInput& input, const marey::calibrate::wand::WandOptions& options = {}) {
  try {
    marey::calibrate::wand::calibrate_wand(input, options);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(CalibrateWand, FindsEightCameras) {
  const marey::simulate::room::RoomScene scene(waved(8, 600));
  const marey::calibrate::wand::WandResult result = marey::calibrate::wand::calibrate_wand(input_of(scene));
  const Off off = compare(result.rig, scene.rig());
  EXPECT_LT(off.centre_mm, 0.3);
  EXPECT_LT(std::abs(off.scale_percent), 0.02);
  ASSERT_TRUE(result.report.held_out);
  EXPECT_NEAR(result.report.held_out->noise_px, 0.1, 0.005);
  EXPECT_GT(result.report.all.inliers, 0.99 * result.report.all.observations);
  EXPECT_LT(std::abs(result.report.held_out->length_mean_mm), 0.1);
}

TEST(CalibrateWand, EstimatesLensesThatAreNotKnown) {
  const marey::simulate::room::RoomScene scene(waved(5, 800));
  const marey::calibrate::wand::WandResult result = marey::calibrate::wand::calibrate_wand(input_of(scene, false));
  EXPECT_LT(compare(result.rig, scene.rig()).centre_mm, 2);
  for (std::size_t c = 0; c < 5; ++c) {
    EXPECT_NEAR(geometry::focal_of(*result.rig.cameras[c].lens).x() / geometry::focal_of(*scene.rig().cameras[c].lens).x(), 1,
                2e-3);
  }
}

TEST(CalibrateWand, SeesThroughGhostsAndGaps) {
  marey::simulate::room::RoomOptions room = waved(6, 500);
  room.ghosts = 0.3;
  room.dropped = 0.2;
  const marey::simulate::room::RoomScene scene(room);
  const marey::calibrate::wand::WandResult result = marey::calibrate::wand::calibrate_wand(input_of(scene));
  EXPECT_LT(compare(result.rig, scene.rig()).centre_mm, 0.5);
  EXPECT_NEAR(result.report.noise_px, 0.1, 0.01);
}

TEST(CalibrateWand, TellsTheEndsOfAWandOfTwoMarkersApart) {
  marey::simulate::room::RoomOptions room = waved(5, 500);
  room.wand = {0, 0.4};
  const marey::simulate::room::RoomScene scene(room);
  EXPECT_LT(compare(marey::calibrate::wand::calibrate_wand(input_of(scene)).rig, scene.rig()).centre_mm, 0.6);
}

TEST(CalibrateWand, ASingleLightGivesTheShapeAndADistanceTheScale) {
  marey::simulate::room::RoomOptions room = waved(5, 500);
  room.wand = {0};
  const marey::simulate::room::RoomScene scene(room);
  marey::calibrate::wand::WandOptions options;
  const Eigen::Matrix3Xd truth = centres_of(scene.rig());
  options.distance = marey::calibrate::wand::KnownDistance{"cam1", "cam3", (truth.col(0) - truth.col(2)).norm()};
  const marey::calibrate::wand::WandResult result = marey::calibrate::wand::calibrate_wand(input_of(scene), options);
  const Eigen::Matrix3Xd found = centres_of(result.rig);
  EXPECT_NEAR((found.col(0) - found.col(2)).norm(), options.distance->metres, 1e-9);
  EXPECT_LT(compare(result.rig, scene.rig()).centre_mm, 2);
}

TEST(CalibrateWand, FindsWhenCamerasWereStarted) {
  marey::simulate::room::RoomOptions room = waved(4, 900);
  room.offset_s = 0.3;
  const marey::simulate::room::RoomScene scene(room);
  const marey::calibrate::wand::WandResult result = marey::calibrate::wand::calibrate_wand(input_of(scene));
  for (std::size_t c = 0; c < 4; ++c) {
    const double truth = *scene.rig().cameras[c].offset_s - *scene.rig().cameras[0].offset_s;
    EXPECT_NEAR(*result.rig.cameras[c].offset_s, truth, 0.05 / 120) << "a twentieth of a frame";
  }
  EXPECT_LT(compare(result.rig, scene.rig()).centre_mm, 1);
}

TEST(CalibrateWand, IsTheSameTwice) {
  const marey::simulate::room::RoomScene scene(waved(3, 200));
  const marey::calibrate::wand::WandInput input = input_of(scene);
  const marey::calibrate::wand::WandResult a = marey::calibrate::wand::calibrate_wand(input),
                                           b = marey::calibrate::wand::calibrate_wand(input);
  EXPECT_EQ(centres_of(a.rig), centres_of(b.rig));
}

TEST(CalibrateWand, RefusesAWandOfOtherProportions) {
  marey::calibrate::wand::WandInput input = input_of(marey::simulate::room::RoomScene(waved(3, 200)));
  input.wand.distances = {0, 0.10, 0.30};
  EXPECT_NE(refusal(input).find("--wand"), std::string::npos) << refusal(input);
}

TEST(CalibrateWand, RefusesAWandThatChanges) {
  const marey::simulate::room::RoomScene scene(waved(4, 400));
  marey::simulate::room::RoomOptions longer = waved(4, 400);
  longer.wand = {0, 0.14, 0.35};
  marey::calibrate::wand::WandInput input = input_of(scene);
  const marey::calibrate::wand::WandInput other = input_of(marey::simulate::room::RoomScene(longer));
  for (std::size_t c = 0; c < 4; ++c)
    std::copy(other.detected[c].begin() + 200, other.detected[c].end(), input.detected[c].begin() + 200);
  EXPECT_NE(refusal(input).find("another wand"), std::string::npos) << refusal(input);
}

TEST(CalibrateWand, RefusesTwoCamerasInOnePlace) {
  marey::calibrate::wand::WandInput input = input_of(marey::simulate::room::RoomScene(waved(4, 200)));
  input.detected[2] = input.detected[1];
  input.rig.cameras[2].lens = input.rig.cameras[1].lens;
  EXPECT_NE(refusal(input).find("one place"), std::string::npos) << refusal(input);
  input.rig.cameras.resize(3), input.rig.cameras.erase(input.rig.cameras.begin());
  input.detected.resize(3), input.detected.erase(input.detected.begin());
  EXPECT_NE(refusal(input).find("one place"), std::string::npos) << refusal(input);
}

TEST(CalibrateWand, RefusesCamerasWithoutACommonView) {
  marey::calibrate::wand::WandInput input = input_of(marey::simulate::room::RoomScene(waved(4, 200)));
  for (std::size_t c = 0; c < 4; ++c) {
    for (std::size_t i = 0; i < 200; ++i) {
      if ((i < 100) == (c < 2)) input.detected[c][i].blobs.clear();
    }
  }
  EXPECT_NE(refusal(input, {.find_offsets = false}).find("share no view"), std::string::npos) << refusal(input);
}

TEST(CalibrateWand, RefusesTooFewPoses) {
  EXPECT_NE(refusal(input_of(marey::simulate::room::RoomScene(waved(3, 12)))).find("needed"), std::string::npos);
}

TEST(CalibrateWand, RefusesAPlane) {
  // A wand that lies flat on its table, pushed round.
  const marey::simulate::room::RoomScene scene(waved(4, 10));
  marey::calibrate::wand::WandInput input = input_of(scene);
  for (std::size_t c = 0; c < 4; ++c) {
    input.detected[c].clear();
    const Camera camera = *scene.rig().cameras[c].camera();
    for (int i = 0; i < 200; ++i) {
      const double turn = 0.05 * i;
      const Vector<3> at(0.8 * std::sin(0.031 * i), 0.8 * std::cos(0.023 * i), 0.7);
      marey::calibrate::wand::BlobFrame frame{i / 120.0, {}};
      for (const double s : input.wand.distances) {
        const auto pixel = camera.project(at + s * Vector<3>(std::cos(turn), std::sin(turn), 0));
        if (pixel) frame.blobs.push_back(*pixel);
      }
      input.detected[c].push_back(frame);
    }
  }
  EXPECT_NE(refusal(input).find("plane"), std::string::npos) << refusal(input);
}

TEST(CalibrateWand, RefusesWhatIsNotThere) {
  marey::calibrate::wand::WandInput input = input_of(marey::simulate::room::RoomScene(waved(3, 100)));
  EXPECT_NE(refusal(input, {.distance = marey::calibrate::wand::KnownDistance{"cam1", "nobody", 1}}).find("nobody"),
            std::string::npos);
  input.rig.cameras[1].size.reset();
  EXPECT_NE(refusal(input).find("size"), std::string::npos);
  input = input_of(marey::simulate::room::RoomScene(waved(3, 100)), false);
  EXPECT_NE(refusal(input, {.lens = marey::calibrate::wand::LensUse::fixed}).find("lens"), std::string::npos);
}

TEST(CalibrateWand, DoesBetterThanMultiCamSelfCal) {
  const std::string folder = test::data("led_rig_4");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is absent";
  marey::calibrate::wand::WandInput input;
  input.rig = format::rig_of_observations(folder);
  input.detected = read_blobs(folder, input.rig).detected;
  const marey::calibrate::wand::WandResult result = marey::calibrate::wand::calibrate_wand(input, {.find_offsets = false});
  EXPECT_LT(result.report.all.mean_px, 0.20) << "its own log: 0.30 px over 303 observations";
  EXPECT_GE(result.report.all.inliers, 1500);
}

TEST(CalibrateGround, FindsTheLFrame) {
  marey::simulate::room::RoomOptions room;
  room.motion = marey::simulate::room::RoomMotion::ground;
  room.cameras = 6;
  room.frames = 30;
  room.ghosts = 0.2;
  const marey::simulate::room::RoomScene scene(room);
  const marey::calibrate::wand::WandInput detected = input_of(scene);
  std::vector<std::vector<Vector<2>>> still;
  for (const auto& frames : detected.detected) still.push_back(marey::calibrate::still_blobs(frames));
  const Rigid3 elsewhere{geometry::rotation_from({0.4, -1.1, 0.3}), {0.5, 1, -2}};
  Rig rig = marey::calibrate::moved_to_ground(scene.rig(), elsewhere, 0.25);
  for (const double scale : {1.0, 4.0}) {
    if (scale == 1.0) rig = marey::calibrate::moved_to_ground(scene.rig(), elsewhere, 1);
    if (scale == 4.0) rig = marey::calibrate::moved_to_ground(scene.rig(), elsewhere, 0.25);
    const marey::calibrate::GroundFound found = marey::calibrate::find_ground(rig, still, room.ground_frame, scale != 1.0);
    EXPECT_NEAR(found.scale, scale, 0.003 * scale);
    const Rig back = marey::calibrate::moved_to_ground(rig, found.ground_from_world, found.scale);
    EXPECT_LT((centres_of(back) - centres_of(scene.rig())).colwise().norm().maxCoeff(), 5e-3);
  }
}

TEST(CalibrateGround, RefusesFramesThatTellNothing) {
  const marey::simulate::room::RoomScene scene(waved(3, 10));
  const std::vector<std::vector<Vector<2>>> nothing(3);
  const std::vector<Vector<3>> line = {{0, 0, 0}, {0.2, 0, 0}, {0.5, 0, 0}}, square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_THROW(marey::calibrate::find_ground(scene.rig(), nothing, line, false), Error);
  EXPECT_THROW(marey::calibrate::find_ground(scene.rig(), nothing, square, false), Error);
  EXPECT_THROW(marey::calibrate::find_ground(scene.rig(), nothing, scene.options().ground_frame, false), Error);
}

}  // namespace
}  // namespace marey::pipeline::calibrate
