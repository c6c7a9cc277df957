#include "marey/calibrate/ground.h"

#include <array>

#include <gtest/gtest.h>

#include "marey/calibrate/wand/wand_scene_test.h"

namespace marey::calibrate {
namespace {

using wand::WandScene;

const std::vector<Vector<3>> kFrame{{0, 0, 0}, {0.2, 0, 0}, {0.6, 0, 0}, {0, 0.4, 0}};  // m

/// What the cameras see of a frame that lies at `world_from_ground`, among `others` that shine; `sigma` px off.
std::vector<std::vector<Vector<2>>> blobs_of(WandScene& scene, const Rigid3& world_from_ground, double size, double sigma,
                                             const std::vector<Vector<3>>& others = {}) {
  std::vector<std::vector<Vector<2>>> blobs;
  for (const RigCamera& camera : scene.rig.cameras) {
    auto& mine = blobs.emplace_back();
    const auto add = [&](const Vector<3>& location) {
      const auto pixel = camera.camera()->project(location);
      if (pixel) mine.push_back(*pixel + Vector<2>(scene.noise.gaussian(sigma), scene.noise.gaussian(sigma)));
    };
    for (const Vector<3>& location : others) add(location);
    for (const Vector<3>& marker : kFrame) add(world_from_ground * (size * marker));
  }
  return blobs;
}

Rigid3 somewhere(board::Noise& noise) {
  return {geometry::rotation_from({noise.uniform(-0.4, 0.4), noise.uniform(-0.4, 0.4), noise.uniform(-3, 3)}),
          {noise.uniform(-0.4, 0.4), noise.uniform(-0.4, 0.4), noise.uniform(0, 0.5)}};
}

std::string refusal_of(const Rig& rig, const std::vector<std::vector<Vector<2>>>& blobs, const std::vector<Vector<3>>& frame) {
  return wand::refusal([&] { find_ground(rig, blobs, frame, false); });
}

TEST(Ground, TheFrameIsFoundAmongOtherLights) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    WandScene scene(seed);
    const Rigid3 world_from_ground = somewhere(scene.noise);
    const auto blobs = blobs_of(scene, world_from_ground, 1, 0.1, {{0.9, 0.3, 1.1}, {-0.7, 0.8, 0.2}, {0.2, -0.9, 0.9}});
    const GroundFound found = find_ground(scene.rig, blobs, kFrame, false);
    EXPECT_NEAR(found.scale, 1, 1e-12);
    EXPECT_LT(found.rms_mm, 1);
    EXPECT_EQ(found.observed_by, std::vector<int>(kFrame.size(), 4));
    for (const Vector<3>& marker : kFrame) {
      EXPECT_LT((found.ground_from_world * (world_from_ground * marker) - marker).norm(), 2e-3);
    }
  }
}

TEST(Ground, TheFramesSizeSetsTheScaleWhereItIsFree) {
  WandScene scene(11);
  const Rigid3 world_from_ground = somewhere(scene.noise);
  const auto blobs = blobs_of(scene, world_from_ground, 0.5, 0);  // the world is half as large as it should be
  const GroundFound found = find_ground(scene.rig, blobs, kFrame, true);
  EXPECT_NEAR(found.scale, 2, 1e-6);
  EXPECT_THROW(find_ground(scene.rig, blobs, kFrame, false), Error);
}

TEST(Ground, FramesThatTellNoFloorAreRefused) {
  WandScene scene(12);
  const auto blobs = blobs_of(scene, {}, 1, 0);
  const std::vector<Vector<3>> two(kFrame.begin(), kFrame.begin() + 2), line(kFrame.begin(), kFrame.begin() + 3);
  const std::vector<Vector<3>> even{{0, 0, 0}, {0.3, 0, 0}, {0, 0.3, 0}};
  EXPECT_NE(refusal_of(scene.rig, blobs, two).find("three markers or more; 2 are given"), std::string::npos);
  EXPECT_NE(refusal_of(scene.rig, blobs, line).find("on a line"), std::string::npos);
  EXPECT_NE(refusal_of(scene.rig, blobs, even).find("appears the same when it is turned"), std::string::npos);
  EXPECT_NE(refusal_of(scene.rig, std::vector<std::vector<Vector<2>>>(4), kFrame).find("is not found"), std::string::npos);
  for (RigCamera& camera : scene.rig.cameras) camera.camera_from_world.reset();
  EXPECT_NE(refusal_of(scene.rig, blobs, kFrame).find("the ground needs two"), std::string::npos);
}

TEST(Ground, BlobsThatStandStillAreAveraged) {
  board::Noise noise(13);
  std::vector<wand::BlobFrame> frames;
  for (int i = 0; i < 60; ++i) {
    wand::BlobFrame frame{i / 60.0, {{200 + noise.gaussian(0.3), 100 + noise.gaussian(0.3)}, {10.0 * i, 300}}};
    if (i % 3 != 0) frame.blobs.emplace_back(400, 400);  // two thirds of the time
    if (i % 3 == 0) frame.blobs.emplace_back(500, 500);  // one third
    frames.push_back(frame);
  }
  const auto still = still_blobs(frames);
  ASSERT_EQ(still.size(), 2U);
  EXPECT_LT((still[0] - Vector<2>(200, 100)).norm(), 0.2);
  EXPECT_LT((still[1] - Vector<2>(400, 400)).norm(), 1e-9);
  EXPECT_TRUE(still_blobs({}).empty());
}

TEST(Ground, AMovedRigSeesTheSame) {
  WandScene scene(14);
  const Rigid3 ground_from_world = somewhere(scene.noise);
  const Rig moved = moved_to_ground(scene.rig, ground_from_world, 3);
  for (std::size_t c = 0; c < scene.rig.cameras.size(); ++c) {
    const Vector<3> point(0.3, -0.2, 0.4);
    const auto before = scene.rig.cameras[c].camera()->project(point);
    const auto after = moved.cameras[c].camera()->project(3 * (ground_from_world * point));
    ASSERT_TRUE(before && after);
    EXPECT_LT((*before - *after).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace marey::calibrate
