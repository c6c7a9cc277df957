#include "marey/reconstruct/camera_plan.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/reconstruct/sight_line.h"
#include "marey/reconstruct/triangulate.h"

namespace marey::reconstruct {
namespace {

/// Four by three metres, cameras on the walls of six by five.
PlannedRoom some_room() {
  PlannedRoom room;
  room.volume = {{-2, -1.5, 0}, {2, 1.5, 2}};
  for (const double z : {1.2, 2.6}) {
    for (int i = -3; i <= 3; ++i) {
      for (const double y : {-2.5, 2.5}) room.mounts.emplace_back(i, y, z);
    }
    for (int j = -2; j <= 2; ++j) {
      for (const double x : {-3.0, 3.0}) room.mounts.emplace_back(x, j, z);
    }
  }
  room.field_of_view = 1.3;
  return room;
}

std::vector<geometry::Camera> cameras_in(const Rig& rig) {
  std::vector<geometry::Camera> cameras;
  for (const RigCamera& one : rig.cameras) cameras.push_back(*one.camera());
  return cameras;
}

RoomCoverage planned(const PlannedRoom& room) {
  return coverage_of(room, cameras_in(plan_cameras(room)));
}

TEST(CameraPlan, TheExpectedErrorIsThatOfNoisyPoints) {
  PlannedRoom room = some_room();
  const auto cameras = cameras_in(plan_cameras(room));
  const Vector<3> truth(0.3, -0.2, 1.1);
  const auto expected = expected_error(truth, cameras, 0.5);
  ASSERT_TRUE(expected);
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.5);
  double squares = 0;
  constexpr int kTrials = 4000;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<SightLine> lines;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      const auto pixel = cameras[i].project(truth);
      if (!pixel || !cameras[i].in_image(*pixel)) continue;
      lines.push_back(*sight_line(cameras[i], static_cast<int>(i), *pixel + Vector<2>(noise(random), noise(random)), 0.5));
    }
    squares += (std::get<SpacePoint>(triangulate(lines, {.reject = false})).position - truth).squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(squares / kTrials) / *expected, 1, 0.04);
}

TEST(CameraPlan, IsBetterThanChance) {
  for (const bool facing : {true, false}) {
    PlannedRoom room = some_room();
    room.facing = facing;
    const RoomCoverage best = planned(room);
    std::mt19937 random(1);
    for (int trial = 0; trial < 30; ++trial) {
      PlannedRoom some = room;
      std::shuffle(some.mounts.begin(), some.mounts.end(), random);
      some.mounts.resize(static_cast<std::size_t>(some.cameras));
      const RoomCoverage chance = planned(some);  // the best directions from these mounts
      EXPECT_GE(best.covered, chance.covered - 0.03) << facing << ' ' << trial;
      if (chance.covered > best.covered - 0.03) {
        EXPECT_LT(best.median_m, 1.15 * chance.median_m) << facing << ' ' << trial;
      }
    }
  }
}

TEST(CameraPlan, MoreCamerasCoverMoreAndExacter) {
  PlannedRoom room = some_room();
  RoomCoverage before{};
  for (const int count : {3, 5, 8, 12}) {
    room.cameras = count;
    const RoomCoverage now = planned(room);
    EXPECT_GT(now.covered, before.covered - 1e-9) << count;
    if (before.covered > 0.95) {
      EXPECT_LT(now.median_m, before.median_m) << count;
    }
    before = now;
  }
  EXPECT_GT(before.covered, 0.98);
}

TEST(CameraPlan, BodiesHideWhatIsBehindThem) {
  PlannedRoom room = some_room();
  room.cameras = 2;
  room.facing = true;
  const double markers = planned(room).covered;
  room.facing = false;
  const double joints = planned(room).covered;
  EXPECT_LT(markers, 0.55) << "two cameras see one side of a body";
  EXPECT_GT(joints, 0.9);
}

TEST(CameraPlan, NothingIsSeenThroughAnObstacleOrFromTooFar) {
  PlannedRoom room = some_room();
  room.facing = false;
  const auto cameras = cameras_in(plan_cameras(room));
  const double open = coverage_of(room, cameras).covered;
  room.obstacles = {{{-0.1, -10, 0}, {0.1, 10, 10}}};  // a wall through the middle
  const double divided = coverage_of(room, cameras).covered;
  EXPECT_LT(divided, open);
  EXPECT_GT(planned(room).covered, divided - 1e-9) << "a plan that knows of the wall";
  room.obstacles = {{{-2.9, -2.4, -1}, {2.9, 2.4, 5}}};
  EXPECT_THROW(plan_cameras(room), Error) << "the volume is in a box";
  room.obstacles.clear();
  room.farthest_m = 0.2;
  EXPECT_THROW(plan_cameras(room), Error);
}

TEST(CameraPlan, NoTwoCamerasHangAtOneMount) {
  PlannedRoom room = some_room();
  room.cameras = 8;
  const auto cameras = cameras_in(plan_cameras(room));
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_GT((cameras[i].centre() - cameras[j].centre()).norm(), 0.1);
  }
  room.mounts.resize(3);
  EXPECT_EQ(plan_cameras(room).cameras.size(), 8U) << "unless there are too few";
}

}  // namespace
}  // namespace marey::reconstruct
