#include "marey/track/ground/ground_visibility.h"

#include <gtest/gtest.h>

#include "marey/track/ground/ground_scene_test.h"

namespace marey::track::ground {
namespace {

using ground_scene::observed_at;
using ground_scene::view_of;

TEST(GroundVisibility, OutsideImageIsNotMissed) {
  GroundVisibility visibility(ground_views({view_of(0, 60, 0, 60)}));
  visibility.set_view({.camera = CameraId{0}}, 0.5);
  EXPECT_EQ(visibility.visible({30, 30}), 1);
  EXPECT_EQ(visibility.visible({-1, 30}), 0);
  EXPECT_EQ(visibility.visible({30, 61}), 0);
  EXPECT_EQ(visibility.visible({0.3, 30}), 0.5) << "at the border half of the people are missed";
}

TEST(GroundVisibility, OccludedPersonIsRarelyVisible) {
  const GroundView view = view_of(0, 60, 0, 60);
  GroundVisibility visibility(ground_views({view}));
  const Observation<2> before = observed_at(view, 0, {30, 30});
  visibility.set_view({.camera = CameraId{0}, .detected = {&before, 1}}, 0.5);
  EXPECT_LT(visibility.visible({30, 30.5}), 0.2);
  EXPECT_EQ(visibility.visible({30, 29.5}), 1) << "he stands before the other";
  EXPECT_EQ(visibility.visible({31, 30.5}), 1) << "he stands beside the other";
  visibility.set_view({.camera = CameraId{0}, .detected = {&before, 1}}, 0.95);
  EXPECT_EQ(visibility.visible({30, 30.5}), 1) << "a box that is barely trusted hides no person";
}

TEST(GroundVisibility, ACameraThatTurnsIsAskedWithTheTimeOfItsFrame) {
  const auto views = ground_views({view_of(0, 60, 0, 60), view_of(0, 60, 0, 60)});
  views->turn(CameraId{1}, timestamp_from_seconds(2), view_of(40, 100, 0, 60));
  GroundVisibility visibility(views);
  for (const double time : {0.0, 1.96, 2.0, 9.0}) {
    visibility.set_view({.camera = CameraId{1}, .time = timestamp_from_seconds(time)}, 0.5);
    EXPECT_EQ(visibility.visible({10, 30}), time < 2 ? 1 : 0) << time;
    EXPECT_EQ(visibility.visible({90, 30}), time < 2 ? 0 : 1) << time;
    visibility.set_view({.camera = CameraId{0}, .time = timestamp_from_seconds(time)}, 0.5);
    EXPECT_EQ(visibility.visible({10, 30}), 1) << "the other stands";
  }
}

TEST(GroundVisibility, RejectsPositionsBehindCamera) {
  Matrix<3> ground_from_image;
  ground_from_image << 1, 0, -50, 0, 1, -300, 0, 0.02, -1;  // the horizon at row 50
  GroundVisibility visibility(ground_views({GroundView(ground_from_image, cv::Size(100, 200))}));
  visibility.set_view({.camera = CameraId{0}}, 0.5);
  const auto in_view = GroundView(ground_from_image, cv::Size(100, 200)).location({50, 150});
  ASSERT_TRUE(in_view);
  EXPECT_EQ(visibility.visible(in_view->ground), 1);
}

}  // namespace
}  // namespace marey::track::ground
