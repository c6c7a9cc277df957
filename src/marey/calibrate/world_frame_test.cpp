#include "marey/calibrate/world_frame.h"

#include <gtest/gtest.h>

#include "marey/calibrate/wand/wand_scene_test.h"

namespace marey::calibrate {
namespace {

using wand::WandScene;

/// A scene's truth as a bundle: wands, points and boards, seen by all cameras.
bundle::Bundle bundle_of(const WandScene& scene) {
  bundle::Bundle bundle;
  bundle.wand = scene.wand.distances;
  bundle.board = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}};
  for (const RigCamera& camera : scene.rig.cameras) bundle.cameras.push_back({*camera.lens, *camera.camera_from_world});
  for (int i = 0; i < 30; ++i) {
    const auto locations = scene.markers(0.2 * i);
    const int last = static_cast<int>(locations.size()) - 1;
    if (i % 3 == 0) bundle.bodies.emplace_back(locations[0]);
    if (i % 3 == 1) bundle.bodies.emplace_back(bundle::WandPose{locations[0], (locations.back() - locations[0]).normalized()});
    if (i % 3 == 2) bundle.bodies.emplace_back(Rigid3{geometry::rotation_from({0.1 * i, 0.2, -0.1}), locations[0]});
    for (int c = 0; c < std::ssize(bundle.cameras); ++c) {
      for (int m = 0; m <= (i % 3 == 0 ? 0 : last); ++m) bundle.observations.push_back({c, i, m});
    }
  }
  for (auto& detected : bundle.observations) detected.pixel = bundle::predicted_pixel(bundle, detected).value();
  return bundle;
}

void expect_same_images(const bundle::Bundle& moved, const bundle::Bundle& before) {
  for (const auto& detected : before.observations) {
    const auto pixel = bundle::predicted_pixel(moved, detected);
    ASSERT_TRUE(pixel);
    EXPECT_LT((*pixel - detected.pixel).norm(), 1e-6);
  }
}

Vector<3> centre(const bundle::Bundle& bundle, std::size_t camera) {
  return bundle.cameras[camera].camera_from_world.inverse().translation;
}

wand::WandInput input_of(const WandScene& scene, bool with_poses) {
  wand::WandInput input{scene.rig, scene.wand, {}};
  for (RigCamera& camera : input.rig.cameras) {
    if (!with_poses) camera.camera_from_world.reset();
  }
  return input;
}

TEST(WorldFrame, MovingKeepsThePictures) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    const WandScene scene(seed);
    const bundle::Bundle before = bundle_of(scene);
    bundle::Bundle bundle = before;
    board::Noise noise(seed);
    const auto any = [&] { return Vector<3>(noise.uniform(-2, 2), noise.uniform(-2, 2), noise.uniform(-2, 2)); };
    const Rigid3 motion{geometry::rotation_from(any()), any()};
    move(bundle, motion, 1);
    expect_same_images(bundle, before);
    EXPECT_LT(
        (bundle::marker_position(bundle, before.observations[0]) - motion * bundle::marker_position(before, before.observations[0]))
            .norm(),
        1e-9);
    move(bundle, motion.inverse(), 1);
    for (std::size_t c = 0; c < bundle.cameras.size(); ++c) EXPECT_LT((centre(bundle, c) - centre(before, c)).norm(), 1e-9);
  }
}

TEST(WorldFrame, AScaleMovesPointsApart) {
  const WandScene scene(2, 3, {{0}});
  const bundle::Bundle before = bundle_of(scene);
  bundle::Bundle bundle = before;
  move(bundle, {}, 2);
  EXPECT_NEAR((centre(bundle, 0) - centre(bundle, 1)).norm(), 2 * (centre(before, 0) - centre(before, 1)).norm(), 1e-9);
}

TEST(WorldFrame, GivenPosesSayWhereTheWorldIs) {
  const WandScene scene(3);
  const bundle::Bundle truth = bundle_of(scene);
  bundle::Bundle bundle = truth;
  move(bundle, {geometry::rotation_from({1, -0.4, 2}), {3, -2, 1}}, 1);
  std::vector<std::string> notes;
  put_into_world(bundle, input_of(scene, true), {}, notes);
  for (std::size_t c = 0; c < bundle.cameras.size(); ++c) EXPECT_LT((centre(bundle, c) - centre(truth, c)).norm(), 1e-9);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0], "the world is where the given poses have it");
}

TEST(WorldFrame, WithoutPosesItStandsUprightInTheMiddle) {
  const WandScene scene(4);
  bundle::Bundle bundle = bundle_of(scene);
  move(bundle, {geometry::rotation_from({1, -0.4, 2}), {3, -2, 1}}, 1);
  std::vector<std::string> notes;
  put_into_world(bundle, input_of(scene, false), {}, notes);
  Vector<3> middle = Vector<3>::Zero();
  for (const auto& detected : bundle.observations)
    middle += bundle::marker_position(bundle, detected) / static_cast<double>(bundle.observations.size());
  EXPECT_LT(middle.norm(), 1e-9);
  for (std::size_t c = 0; c < bundle.cameras.size(); ++c) EXPECT_GT(centre(bundle, c).z(), 0) << "the cameras hang above";
  expect_same_images(bundle, bundle_of(scene));
}

TEST(WorldFrame, ASingleLightsScaleComesFromADistance) {
  const WandScene scene(5, 3, {{0}});
  bundle::Bundle bundle = bundle_of(scene);
  std::vector<std::string> notes;
  wand::WandOptions options;
  options.distance = wand::KnownDistance{"cam1", "cam3", 7};
  put_into_world(bundle, input_of(scene, false), options, notes);
  EXPECT_NEAR((centre(bundle, 0) - centre(bundle, 2)).norm(), 7, 1e-9);
  put_into_world(bundle, input_of(scene, false), {}, notes);
  EXPECT_NEAR((centre(bundle, 0) - centre(bundle, 1)).norm(), 1, 1e-9);
  EXPECT_NE(notes[1].find("a single light tells no size"), std::string::npos) << notes[1];
}

}  // namespace
}  // namespace marey::calibrate
