#include "marey/geometry/tripod.h"

#include <gtest/gtest.h>

namespace marey::geometry {
namespace {

const Tripod kTripod{{52, -31, 15}, {0.004, -0.006}, 0.008, 0.3, 0.02};
const cv::Size kSize{1280, 720};

TEST(Tripod, CameraSeesWhatTheFrameSees) {
  for (const Heading heading : {Heading{0, 0.25, 1.0}, Heading{0.6, 0.2, 1.5}, Heading{-0.7, 0.3, 0.8}}) {
    const Camera camera = camera_of(kTripod, heading, kSize);
    const auto numbers = kTripod.as_numbers();
    const Vector<3> rotated = heading.as_vector();
    const TripodFrame<double> frame(numbers.data(), rotated.data());
    for (const Vector<3>& location : {Vector<3>(52, 20, 0), Vector<3>(80, 40, 1.5), Vector<3>(20, 60, 0)}) {
      if (frame.depth(location) < 1) continue;
      const auto pixel = camera.project(location);
      ASSERT_TRUE(pixel.has_value());
      EXPECT_LT((*pixel - to_pixel(frame.detected(location), kSize)).norm(), 1e-6);
    }
  }
}

TEST(Tripod, PanGrowsToTheRightAndTiltDownwards) {
  Tripod upright;
  upright.location = {0, 0, 10};
  const Vector<3> location(0, 50, 0);
  const auto at = [&](double pan, double tilt) { return *camera_of(upright, {pan, tilt, 1}, kSize).project(location); };
  EXPECT_LT(at(0.1, 0.2).x(), at(0, 0.2).x());
  EXPECT_LT(at(0, 0.25).y(), at(0, 0.2).y());
}

TEST(Tripod, PixelsRoundTrip) {
  const Vector<2> pixel(17, 611);
  EXPECT_LT((to_pixel(from_pixel(pixel, kSize), kSize) - pixel).norm(), 1e-9);
}

TEST(Tripod, CentreOfProjectionTurnsRoundTheAxes) {
  const Camera left = camera_of(kTripod, {-0.5, 0.2, 1}, kSize), right = camera_of(kTripod, {0.5, 0.2, 1}, kSize);
  EXPECT_NEAR((left.centre() - kTripod.location).norm(), 0.3, 1e-9);
  EXPECT_GT((left.centre() - right.centre()).norm(), 0.25);
}

}  // namespace
}  // namespace marey::geometry
