#include "marey/calibrate/resection.h"

#include <gtest/gtest.h>

#include "marey/calibrate/wand/wand_scene_test.h"

namespace marey::calibrate {
namespace {

using wand::WandScene;

/// The wand as camera 0 of a scene sees it; every third view turned round where asked for.
std::vector<MarkObservation> wands_of(WandScene& scene, int count, double sigma_px, bool rotated = false) {
  std::vector<MarkObservation> wands;
  const Camera lens(*scene.rig.cameras[0].lens, {}, *scene.rig.cameras[0].size);
  for (int i = 0; static_cast<int>(wands.size()) < count; ++i) {
    const auto marks = scene.detected(0, 0.17 * i, sigma_px);
    if (!marks) continue;
    const auto locations = scene.markers(0.17 * i);
    MarkObservation wand{};
    for (std::size_t m = 0; m < locations.size(); ++m) {
      const bool turn = rotated && wands.size() % 3 == 0;
      wand.world[m] = locations[m];
      wand.bearing[turn ? locations.size() - 1 - m : m] = *lens.bearing(*(*marks)[m]);
    }
    wands.push_back(wand);
  }
  return wands;
}

void expect_pose(const Rigid3& found, const Rigid3& truth, double rad, double metres) {
  EXPECT_LT(wand::angle_between(found.rotation, truth.rotation), rad);
  EXPECT_LT((found.inverse().translation - truth.inverse().translation).norm(), metres);
}

TEST(Resection, FindsTheCameraByExactWands) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    WandScene scene(seed);
    const auto wands = wands_of(scene, 20, 0);
    const auto found = resect(wands, {.markers = 3, .seed = seed});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->inliers, wands.size());
    expect_pose(found->camera_from_world, *scene.rig.cameras[0].camera_from_world, 1e-4, 1e-3);
  }
}

TEST(Resection, WrongWandsAreNamedAndDoNotMatter) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    WandScene scene(seed);
    auto wands = wands_of(scene, 30, 0.3);
    for (std::size_t i = 0; i < wands.size(); i += 4) wands[i].world = wands[(i + 7) % wands.size()].world;
    const auto found = resect(wands, {.markers = 3, .seed = seed});
    ASSERT_TRUE(found);
    expect_pose(found->camera_from_world, *scene.rig.cameras[0].camera_from_world, 0.02, 0.06);
    for (std::size_t i = 0; i < wands.size(); ++i) EXPECT_EQ(found->inlier[i] != 0, i % 4 != 0) << i;
  }
}

TEST(Resection, AReversibleWandsViewsAreTurned) {
  WandScene scene(4, 4, {{0, 0.15, 0.30}});
  const auto wands = wands_of(scene, 21, 0, true);
  const auto found = resect(wands, {.markers = 3, .reversible = true, .seed = 2});
  ASSERT_TRUE(found);
  expect_pose(found->camera_from_world, *scene.rig.cameras[0].camera_from_world, 1e-3, 1e-2);
  for (std::size_t i = 0; i < wands.size(); ++i) EXPECT_EQ(found->rotated[i] != 0, i % 3 == 0) << i;
}

TEST(Resection, TheSameSeedGivesTheSameBits) {
  WandScene scene(6);
  const auto wands = wands_of(scene, 20, 0.5);
  const auto a = resect(wands, {.markers = 3, .seed = 9}), b = resect(wands, {.markers = 3, .seed = 9});
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->camera_from_world.rotation, b->camera_from_world.rotation);
  EXPECT_EQ(a->camera_from_world.translation, b->camera_from_world.translation);
}

TEST(Resection, TooFewWandsOrNoneThatFitGiveNothing) {
  WandScene scene(7);
  auto wands = wands_of(scene, 12, 0);
  EXPECT_FALSE(resect(std::span(wands).first(3), {.markers = 3}));
  board::Noise noise(8);
  for (MarkObservation& wand : wands) {
    for (auto& bearing : wand.bearing) bearing = Vector<3>(noise.uniform(-1, 1), noise.uniform(-1, 1), 1).normalized();
  }
  EXPECT_FALSE(resect(wands, {.markers = 3}));
}

}  // namespace
}  // namespace marey::calibrate
