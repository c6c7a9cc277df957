#include "marey/core/ground_views.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey {
namespace {

/// 0.1 m a pixel, the ground's (left, 0) at the top-left pixel.
GroundView view_from(double left) {
  Matrix<3> ground_from_image;
  ground_from_image << 0.1, 0, left, 0, 0.1, 0, 0, 0, 1;
  return GroundView(ground_from_image, cv::Size(100, 100));
}

double left_at(const GroundViews& views, int camera, double time) {
  return views.view_at(CameraId{camera}, timestamp_from_seconds(time)).location({0, 0})->ground.x();
}

TEST(GroundViews, ACameraThatStandsHasOneViewForGood) {
  const GroundViews views({view_from(3), view_from(7)});
  EXPECT_EQ(views.cameras(), 2);
  for (const double time : {-1.0, 0.0, 5400.0}) {
    EXPECT_EQ(left_at(views, 0, time), 3);
    EXPECT_EQ(left_at(views, 1, time), 7);
  }
}

TEST(GroundViews, ACameraThatTurnsIsAskedWithATime) {
  GroundViews views({view_from(0), view_from(7)});
  const GroundView& first = views.view_at(CameraId{0}, timestamp_from_seconds(0.5));
  for (int i = 1; i <= 100; ++i) views.turn(CameraId{0}, timestamp_from_seconds(i), view_from(i));
  EXPECT_EQ(left_at(views, 0, 0.9), 0) << "before it turned";
  EXPECT_EQ(left_at(views, 0, 1), 1) << "from that very time on";
  EXPECT_EQ(left_at(views, 0, 41.5), 41);
  EXPECT_EQ(left_at(views, 0, 1e4), 100);
  EXPECT_EQ(left_at(views, 1, 41.5), 7) << "another camera turned";
  EXPECT_EQ(first.location({0, 0})->ground.x(), 0) << "a view that was given stays as it is";
}

TEST(GroundViews, TurnsAreToldInTheOrderOfTime) {
  GroundViews views({view_from(0)});
  views.turn(CameraId{0}, timestamp_from_seconds(2), view_from(2));
  EXPECT_THROW(views.turn(CameraId{0}, timestamp_from_seconds(2), view_from(3)), Error);
  EXPECT_THROW(views.turn(CameraId{0}, timestamp_from_seconds(1), view_from(3)), Error);
}

}  // namespace
}  // namespace marey
