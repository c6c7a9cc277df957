#include "marey/calibrate/line_placement.h"

#include <gtest/gtest.h>

#include "marey/calibrate/wand/wand_scene_test.h"

namespace marey::calibrate {
namespace {

using wand::WandScene;

void stand(LinePlacement& placement, const WandScene& scene) {
  for (std::size_t c = 0; c < scene.rig.cameras.size(); ++c) placement.poses[c] = scene.rig.cameras[c].camera_from_world;
}

TEST(LinePlacement, PlacesTheWandWhereItIs) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    WandScene scene(seed);
    const MarkTable table = scene.table(40, 0);
    LinePlacement placement(scene.cameras(), scene.wand, table);
    stand(placement, scene);
    placement.position_all();
    for (std::size_t i = 0; i < placement.instants(); ++i) {
      ASSERT_TRUE(placement.bodies[i]) << i;
      const auto truth = scene.markers(0.11 * static_cast<double>(i));
      for (std::size_t m = 0; m < 3; ++m) EXPECT_LT((placement.marker_at(*placement.bodies[i], m) - truth[m]).norm(), 1e-6);
    }
  }
}

TEST(LinePlacement, SingleCameraOrSkewRaysLeaveUnlocated) {
  WandScene scene(6);
  MarkTable table = scene.table(10, 0);
  for (std::size_t c = 1; c < 4; ++c) table[3][c].reset();  // seen by one
  for (std::size_t m = 0; m < 3; ++m) *(*table[5][0])[m] += Vector<2>(0, 300);
  for (std::size_t c = 2; c < 4; ++c) table[5][c].reset();  // two that contradict each other
  LinePlacement placement(scene.cameras(), scene.wand, table);
  placement.position_all();
  for (const auto& body : placement.bodies) EXPECT_FALSE(body) << "no camera stands yet";
  stand(placement, scene);
  placement.position_all();
  EXPECT_FALSE(placement.bodies[3]);
  EXPECT_FALSE(placement.bodies[5]);
  EXPECT_TRUE(placement.bodies[4]);
}

TEST(LinePlacement, AWandOfAnotherLengthIsNotPlacedButMeasured) {
  WandScene scene(7);
  const MarkTable table = scene.table(10, 0);
  LinePlacement placement(scene.cameras(), {{0, 0.18, 0.45}}, table);  // said to be half as long again
  stand(placement, scene);
  placement.position_all();
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_FALSE(placement.bodies[i]) << i;
    const auto markers = placement.markers(i);
    ASSERT_TRUE(markers) << i;
    EXPECT_NEAR(((*markers)[2] - (*markers)[0]).norm(), 0.3, 1e-6);
  }
}

TEST(LinePlacement, ViewsOfAReversibleWandAreTurnedToFitTheFirst) {
  WandScene scene(8, 4, {{0, 0.15, 0.30}});
  MarkTable table = scene.table(20, 0);
  const MarkTable straight = table;
  for (std::size_t i = 0; i < table.size(); ++i) std::swap((*table[i][1 + i % 3])[0], (*table[i][1 + i % 3])[2]);
  LinePlacement placement(scene.cameras(), scene.wand, table);
  stand(placement, scene);
  placement.position_all();
  for (std::size_t i = 0; i < table.size(); ++i) {
    ASSERT_TRUE(placement.bodies[i]) << i;
    for (std::size_t c = 0; c < 4; ++c) {
      EXPECT_EQ(placement.rotated[i][c] != 0, c == 1 + i % 3) << i << ' ' << c;
      EXPECT_EQ(placement.pixel(i, c, 0), *(*straight[i][c])[0]);
    }
  }
}

TEST(LinePlacement, SigmasAreAnglesAndFollowTheLens) {
  WandScene scene(9);
  const MarkTable table = scene.table(3, 0);
  LinePlacement placement(scene.cameras(2), scene.wand, table);
  EXPECT_NEAR(placement.sigma(0), 2 / 1100.0, 1e-12);
  const Vector<3> before = placement.bearings(0, 0)[0];
  placement.set_lens(0, geometry::BrownLens{{2200, 2200}, {639.5, 511.5}, {}});
  EXPECT_NEAR(placement.sigma(0), 2 / 2200.0, 1e-12);
  EXPECT_GT((placement.bearings(0, 0)[0] - before).norm(), 1e-4);
}

}  // namespace
}  // namespace marey::calibrate
