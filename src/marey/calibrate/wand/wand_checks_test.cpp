#include "marey/calibrate/wand/wand_checks.h"

#include <gtest/gtest.h>

#include "marey/calibrate/wand/wand_scene_test.h"

namespace marey::calibrate::wand {
namespace {

WandInput input_of(const WandScene& scene) {
  return {scene.rig, scene.wand, std::vector<std::vector<BlobFrame>>(scene.rig.cameras.size(), std::vector<BlobFrame>(100))};
}

std::string refusal_of(const WandInput& input, const WandOptions& options = {}) {
  return refusal([&] { check_wand_input(input, options); });
}

testing::AssertionResult states(const std::string& why, const std::string& part) {
  if (why.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << '"' << why << "\" does not specify \"" << part << '"';
}

TEST(WandChecks, InputThatCannotBecomeARigIsRefused) {
  const WandScene scene(1);
  EXPECT_EQ(refusal_of(input_of(scene)), "");
  WandInput alone = input_of(scene);
  alone.rig.cameras.resize(1);
  EXPECT_TRUE(states(refusal_of(alone), "two cameras or more; the rig has 1"));
  for (const std::vector<double>& distances :
       {std::vector<double>{}, {0.1, 0.2}, {0, 0.3, 0.1}, {0, 0.1, 0.1}, {0, 0.1, 0.2, 0.3}}) {
    WandInput input = input_of(scene);
    input.wand.distances = distances;
    EXPECT_TRUE(states(refusal_of(input), "two or three distances")) << distances.size();
  }
  WandInput sizeless = input_of(scene);
  sizeless.rig.cameras[2].size.reset();
  EXPECT_TRUE(states(refusal_of(sizeless), "camera \"cam3\": its image's size is not known"));
  WandInput lensless = input_of(scene);
  lensless.rig.cameras[1].lens.reset();
  EXPECT_EQ(refusal_of(lensless), "");
  WandOptions held;
  held.lens = LensUse::fixed;
  EXPECT_TRUE(states(refusal_of(lensless, held), "camera \"cam2\" has no lens to be held"));
}

TEST(WandChecks, AKnownDistanceIsBetweenTwoOfTheCameras) {
  const WandScene scene(2);
  const auto with = [&](const char* first, const char* second, double metres) {
    WandOptions options;
    options.distance = KnownDistance{first, second, metres};
    return refusal_of(input_of(scene), options);
  };
  EXPECT_EQ(with("cam1", "cam2", 3), "");
  EXPECT_TRUE(states(with("cam1", "cam9", 3), "\"cam9\", which the rig does not have"));
  EXPECT_TRUE(states(with("cam1", "cam1", 3), "twice"));
  EXPECT_TRUE(states(with("cam1", "cam2", 0), "positive"));
  EXPECT_TRUE(states(with("cam1", "cam2", std::nan("")), "positive"));
}

TEST(WandChecks, EveryCameraMustHaveSeenTheWandOften) {
  const WandScene scene(3);
  const WandInput input = input_of(scene);
  std::vector<MarkTrack> tracks(4, MarkTrack{std::vector<MarkFrame>(20), 0.02, 0});
  EXPECT_EQ(refusal([&] { check_tracks(input, tracks); }), "");
  tracks[1].frames.resize(19);
  EXPECT_TRUE(states(refusal([&] { check_tracks(input, tracks); }), "camera \"cam2\": the wand is seen in 19 of 100 frames"));
}

TEST(WandChecks, AWandThatChangesItsLengthIsRefused) {
  board::Noise noise(4);
  std::vector<double> lengths;
  for (int i = 0; i < 400; ++i) lengths.push_back(0.3 + noise.gaussian(0.002));
  EXPECT_EQ(refusal([&] { check_lengths(lengths, {{0, 0.12, 0.30}}); }), "");
  std::vector<double> changed = lengths;
  for (std::size_t i = 300; i < 400; ++i) changed[i] += 0.02;
  EXPECT_TRUE(states(refusal([&] { check_lengths(changed, {{0, 0.12, 0.30}}); }), "it was another wand"));
  EXPECT_EQ(refusal([&] { check_lengths(changed, {{0}}); }), "") << "a light has no length";
  EXPECT_EQ(refusal([&] { check_lengths(std::vector(changed.end() - 30, changed.end()), {{0, 0.3}}); }), "") << "too few to tell";
}

/// A fitted rig of a scene: every marker of `instants` instants an inlier.
struct Fitted {
  bundle::Bundle bundle;
  bundle::BundleResult fit;

  Fitted(const WandScene& scene, int instants, const Vector<3>& squeeze = {1, 1, 1}) {
    bundle.wand = {0};
    for (const RigCamera& camera : scene.rig.cameras) bundle.cameras.push_back({*camera.lens, *camera.camera_from_world});
    for (int i = 0; i < instants; ++i) {
      bundle.bodies.emplace_back(Vector<3>(scene.markers(0.1 * i)[0].cwiseProduct(squeeze)));
      for (int c = 0; c < 4; ++c) bundle.observations.push_back({c, i, 0});
    }
    fit.inlier.assign(bundle.observations.size(), 1);
  }

  std::string refusal_of(const WandScene& scene) const {
    return refusal([&] { check_fitted_rig(input_of(scene), bundle, fit); });
  }
};

TEST(WandChecks, AFittedRigMustHaveAVolumeAndPlacesOfItsOwn) {
  const WandScene scene(5);
  EXPECT_EQ(Fitted(scene, 60).refusal_of(scene), "");
  EXPECT_TRUE(states(Fitted(scene, 29).refusal_of(scene), "only 29 places of the wand"));
  EXPECT_TRUE(states(Fitted(scene, 60, {1, 1, 0}).refusal_of(scene), "in a plane"));
  EXPECT_TRUE(states(Fitted(scene, 60, {1, 0, 0}).refusal_of(scene), "along a line"));
  Fitted twice(scene, 60);
  twice.bundle.cameras[3] = twice.bundle.cameras[1];
  EXPECT_TRUE(states(twice.refusal_of(scene), "cameras \"cam2\" and \"cam4\" stand in one place"));
  Fitted lonely(scene, 60);
  for (std::size_t i = 0; i < lonely.fit.inlier.size(); ++i) lonely.fit.inlier[i] = i % 4 != 2 || i < 40;
  EXPECT_TRUE(states(lonely.refusal_of(scene), "camera \"cam3\": only 10 of its views"));
}

}  // namespace
}  // namespace marey::calibrate::wand
