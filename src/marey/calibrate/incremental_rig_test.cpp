#include "marey/calibrate/incremental_rig.h"

#include <gtest/gtest.h>

#include "marey/calibrate/wand/wand_scene_test.h"

namespace marey::calibrate {
namespace {

using wand::WandScene;

/// m: the worst difference of a distance between two cameras; independent of the frame.
double worst_distance(const Growth& growth, const WandScene& scene) {
  double worst = 0;
  const auto centre = [](const Rigid3& pose) { return pose.inverse().translation; };
  for (std::size_t a = 0; a < scene.rig.cameras.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const double found =
          (centre(growth.bundle.cameras[a].camera_from_world) - centre(growth.bundle.cameras[b].camera_from_world)).norm();
      const double true_distance =
          (centre(*scene.rig.cameras[a].camera_from_world) - centre(*scene.rig.cameras[b].camera_from_world)).norm();
      worst = std::max(worst, std::abs(found - true_distance));
    }
  }
  return worst;
}

std::string refusal_of(const std::vector<StartingCamera>& cameras, const MarkerLine& shape, const MarkTable& table) {
  return wand::refusal([&] { grow_rig(cameras, shape, table, 1); });
}

TEST(GrowRig, CamerasStandWhereTheyShould) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    WandScene scene(seed);
    const auto table = scene.table(80, 0.2);
    const Growth growth = grow_rig(scene.cameras(), scene.wand, table, seed);
    ASSERT_EQ(growth.bundle.cameras.size(), 4U);
    EXPECT_LT(worst_distance(growth, scene), 0.02);
    EXPECT_NEAR(growth.fit.noise_px, 0.2, 0.06);
  }
}

TEST(GrowRig, CamerasWithoutACommonViewAreChained) {
  WandScene scene(4);
  auto table = scene.table(160, 0);
  for (std::size_t i = 0; i < table.size(); ++i) table[i][i < 80 ? 3 : 0].reset();  // the first and the last never together
  EXPECT_EQ(shared_views(table, 4)[0][3], 0);
  EXPECT_LT(worst_distance(grow_rig(scene.cameras(), scene.wand, table, 1), scene), 0.01);
}

TEST(GrowRig, TheSameSeedGivesTheSameBits) {
  WandScene scene(5);
  const auto table = scene.table(60, 0.3);
  const Growth a = grow_rig(scene.cameras(), scene.wand, table, 7), b = grow_rig(scene.cameras(), scene.wand, table, 7);
  for (std::size_t c = 0; c < a.bundle.cameras.size(); ++c)
    EXPECT_EQ(a.bundle.cameras[c].camera_from_world.translation, b.bundle.cameras[c].camera_from_world.translation);
}

TEST(GrowRig, RejectsImpossibleRigWithCause) {
  WandScene scene(6);
  const auto table = scene.table(80, 0);
  const std::string proportions = refusal_of(scene.cameras(), {{0, 0.2, 0.30}}, table);
  EXPECT_NE(proportions.find("the wand's middle marker lies at 40 % of its length"), std::string::npos) << proportions;
  auto one_position = table;
  auto cameras = scene.cameras();
  for (auto& row : one_position) {
    for (std::size_t c = 1; c < 4; ++c) row[c] = row[0];
  }
  for (auto& camera : cameras) camera.lens = cameras[0].lens;
  EXPECT_NE(refusal_of(cameras, scene.wand, one_position), "");
  EXPECT_NE(refusal_of(scene.cameras(), scene.wand, scene.table(2, 0)), "");
}

TEST(GrowRig, RefusalNamesTheSubject) {
  WandScene scene(6);
  GrowthSubject people;
  people.name = "people";
  people.more = "let them walk longer";
  const std::string why = wand::refusal([&] { grow_rig(scene.cameras(), scene.wand, scene.table(2, 0), 1, people); });
  EXPECT_EQ(why, "no two cameras see people together often enough to begin: let them walk longer");
}

TEST(GrowRig, SharedViewsAreCountedPairByPair) {
  board::Noise noise(8);
  MarkTable table(50, std::vector<std::optional<Marks>>(3));
  std::vector<std::vector<int>> expected(3, std::vector<int>(3, 0));
  for (auto& row : table) {
    for (auto& view : row) {
      if (noise.uniform() < 0.6) view = Marks{};
    }
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) expected[a][b] += row[a].has_value() && row[b].has_value();
    }
  }
  EXPECT_EQ(shared_views(table, 3), expected);
}

TEST(GrowRig, GroupsWithoutACommonViewAreNamed) {
  const std::vector<std::string> names{"a", "b", "c", "d"};
  std::vector<std::vector<int>> shared{{0, 20, 0, 0}, {20, 0, 3, 0}, {0, 3, 0, 40}, {0, 0, 40, 0}};
  const std::string why = wand::refusal([&] { require_connected(names, shared, 12); });
  EXPECT_NE(why.find("cameras a, b share no view with c, d"), std::string::npos) << why;
  shared[1][2] = shared[2][1] = 12;
  EXPECT_EQ(wand::refusal([&] { require_connected(names, shared, 12); }), "");
}

}  // namespace
}  // namespace marey::calibrate
