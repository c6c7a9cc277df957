#include "marey/track/contour/shared_outlines.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/core/outline.h"
#include "marey/geometry/bspline.h"
#include "marey/track/contour/colour/colour_patch.h"

namespace marey::track::contour {
namespace {

constexpr double kStature = 60;  // px
const Vector<2> kStanding(60, 50);

std::vector<Vector<2>> body_about(const Vector<2>& centre, double factor) {
  std::vector<Vector<2>> polygon;
  for (int i = 0; i < 90; ++i) {
    const double angle = 2 * std::numbers::pi * i / 90;
    polygon.emplace_back(centre + factor * Vector<2>(0.2 * kStature * std::cos(angle), 0.5 * kStature * std::sin(angle)));
  }
  return polygon;
}

/// A bright person on a grey lawn, and the earlier data of them.
struct Scene {
  Image image;
  cv::Mat mask = cv::Mat::zeros(100, 120, CV_8UC1);
  ContourTarget target;

  static ContourTarget known(const std::vector<Vector<2>>& polygon) {
    const geometry::ClosedSpline spline = *geometry::fit_spline(polygon, {.order = 4, .minimum = 16, .maximum = 16});
    return {.id = TrackId{1},
            .shape = ShapeFilter(spline, 0.5),
            .motion = MotionFilter(kStanding, Vector<2>::Zero(), 0, 1, 1, 1),
            .height = kStature,
            .typical_area = spline.area(),
            .tracked_height = kStature,
            .predicted = spline};
  }

  Scene() : target(known(body_about(kStanding, 1))) {
    cv::Mat luma(100, 120, CV_8UC1, cv::Scalar(90));
    std::vector<cv::Point> corners;
    for (const Vector<2>& p : body_about(kStanding, 1)) corners.emplace_back(cvRound(p.x()), cvRound(p.y()));
    cv::fillPoly(luma, std::vector{corners}, cv::Scalar(220));
    cv::fillPoly(mask, std::vector{corners}, cv::Scalar(255));
    image = Image(luma);
    const colour::ColourPatch patch = colour::cut_patch(image, mask, {10, 0, 100, 100}, 1);
    const cv::Mat fraction = colour::cells_within(body_about(kStanding, 1), patch);
    target.body.learn_colours(patch, fraction, kStanding, kStature, 1);
    target.body.learn_coverage(patch, fraction, kStanding, kStature, 1);
    target.learned = 50;
  }

  void divide() {
    std::vector<SharedTarget> targets{{&target, {48, 20, 24, kStature}, true}};
    outline_shared_region(image, mask, nullptr, targets);
  }
};

TEST(OutlineSharedRegion, UsesCurrentTrackerSize) {
  Scene scene;
  scene.target.typical_area *= 3;  // of when it was nearer
  scene.target.tracked_height *= std::sqrt(3.0);
  scene.divide();
  EXPECT_NE(scene.target.state, Outline::State::held);
  EXPECT_NEAR(scene.target.shape.spline().area(), geometry::polygon_area(body_about(kStanding, 1)), 150);
}

TEST(OutlineSharedRegion, ABodyOfAnotherSizeIsNotBelieved) {
  Scene scene;
  scene.target.typical_area *= 3;
  scene.divide();
  EXPECT_EQ(scene.target.state, Outline::State::held);
  ASSERT_TRUE(scene.target.measured.has_value()) << "but its place is";
  EXPECT_LT((scene.target.measured->centre - kStanding).norm(), 3);
}

}  // namespace
}  // namespace marey::track::contour
