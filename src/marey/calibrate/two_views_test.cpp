#include "marey/calibrate/two_views.h"

#include <gtest/gtest.h>

#include "marey/calibrate/wand/wand_scene_test.h"

namespace marey::calibrate {
namespace {

using wand::WandScene;

struct Two {
  Rigid3 a, b;  // camera_from_world
};

/// Wands seen by two cameras, bearings `sigma` rad off. `flatten` squeezes them into a plane.
std::vector<MarkPair> pairs_of(const Two& cameras, const WandScene& scene, int count, double sigma, board::Noise& noise,
                               bool flatten = false) {
  std::vector<MarkPair> pairs;
  const auto bearing = [&](const Rigid3& camera, const Vector<3>& point) {
    const Vector<3> off(noise.gaussian(sigma), noise.gaussian(sigma), noise.gaussian(sigma));
    return Vector<3>(((camera * point).normalized() + off).normalized());
  };
  for (int i = 0; i < count; ++i) {
    MarkPair pair{};
    const auto locations = scene.markers(0.23 * i);
    for (std::size_t m = 0; m < locations.size(); ++m) {
      Vector<3> location = locations[m];
      if (flatten) location.z() = 0.3;
      pair.a[m] = bearing(cameras.a, location);
      pair.b[m] = bearing(cameras.b, location);
    }
    pairs.push_back(pair);
  }
  return pairs;
}

Two of(const WandScene& scene) {
  return {*scene.rig.cameras[0].camera_from_world, *scene.rig.cameras[1].camera_from_world};
}

void expect_relation(const TwoViews& found, const Two& truth, double rad) {
  const Rigid3 b_from_a = truth.b * truth.a.inverse();
  EXPECT_LT(wand::angle_between(found.b_from_a.rotation, b_from_a.rotation), rad);
  EXPECT_LT(std::acos(std::min(1.0, found.b_from_a.translation.dot(b_from_a.translation.normalized()))), rad);
  EXPECT_NEAR(found.b_from_a.translation.norm(), 1, 1e-9);
}

TEST(TwoViews, FindsHowTheCamerasStand) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const WandScene scene(seed);
    board::Noise noise(seed);
    const auto found = relate(pairs_of(of(scene), scene, 60, 0, noise), {.markers = 3, .seed = seed});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->fraction, 1);
    EXPECT_FALSE(found->plane);
    EXPECT_FALSE(found->one_position);
    EXPECT_GT(found->parallax, 0.5);
    expect_relation(*found, of(scene), 1e-5);
  }
}

TEST(TwoViews, PairsThatDoNotBelongTogetherArePutOut) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const WandScene scene(seed);
    board::Noise noise(seed);
    auto pairs = pairs_of(of(scene), scene, 90, 2e-4, noise);
    for (std::size_t i = 0; i < pairs.size(); i += 3) pairs[i].b = pairs[(i + 40) % pairs.size()].b;
    const auto found = relate(pairs, {.markers = 3, .seed = seed});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->fraction, 2.0 / 3, 0.08);
    expect_relation(*found, of(scene), 0.03);
  }
}

TEST(TwoViews, TurnedWandsAreTurnedBack) {
  const WandScene scene(5, 4, {{0, 0.15, 0.30}});
  board::Noise noise(5);
  auto pairs = pairs_of(of(scene), scene, 60, 0, noise);
  for (std::size_t i = 0; i < pairs.size(); i += 2) std::swap(pairs[i].b[0], pairs[i].b[2]);
  const auto found = relate(pairs, {.markers = 3, .reversible = true, .seed = 1});
  ASSERT_TRUE(found);
  EXPECT_GT(found->fraction, 0.98);
  expect_relation(*found, of(scene), 1e-3);
  int right = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) right += (found->rotated[i] != 0) == (i % 2 == 0);
  EXPECT_GE(right, 58);
}

TEST(TwoViews, APlaneAndOnePlaceAreSaid) {
  const WandScene scene(6);
  board::Noise noise(6);
  const auto flat = relate(pairs_of(of(scene), scene, 60, 1e-4, noise, true), {.markers = 3, .seed = 1});
  ASSERT_TRUE(flat);
  EXPECT_TRUE(flat->plane);
  Two rotated = of(scene);
  rotated.b = Rigid3{geometry::rotation_from({0.1, -0.2, 0.05}), Vector<3>::Zero()} * rotated.a;
  const auto same = relate(pairs_of(rotated, scene, 60, 1e-4, noise), {.markers = 3, .seed = 1});
  ASSERT_TRUE(same);
  EXPECT_TRUE(same->one_position || same->plane);
  EXPECT_LT(same->parallax, 0.01);
}

TEST(TwoViews, TooFewOrNothingInCommonGiveNothing) {
  const WandScene scene(7);
  board::Noise noise(7);
  EXPECT_FALSE(relate(pairs_of(of(scene), scene, 2, 0, noise), {.markers = 3}));
  auto pairs = pairs_of(of(scene), scene, 80, 0, noise);
  for (MarkPair& pair : pairs) {
    for (auto& bearing : pair.b) bearing = Vector<3>(noise.uniform(-1, 1), noise.uniform(-1, 1), 1).normalized();
  }
  EXPECT_FALSE(relate(pairs, {.markers = 3, .max_draws = 300}));
}

}  // namespace
}  // namespace marey::calibrate
