#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"
#include "marey/geometry/bspline.h"

#include "experiments/box_filter.h"
#include "experiments/published_outline.h"

namespace marey::experiments {
namespace {

constexpr double kRate = 25;  // Hz

std::vector<Vector<2>> disc(double x) {
  std::vector<Vector<2>> corners;
  for (int i = 0; i < 40; ++i) {
    const double angle = 2 * std::numbers::pi * i / 40;
    corners.emplace_back(x + 15 * std::cos(angle), 60 + 15 * std::sin(angle));
  }
  return corners;
}

/// Intersection over union of two convex polygons.
double overlap(const std::vector<Vector<2>>& a, const std::vector<Vector<2>>& b) {
  const auto points = [](const std::vector<Vector<2>>& polygon) {
    std::vector<cv::Point2f> all;
    for (const Vector<2>& corner : polygon) all.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
    return all;
  };
  std::vector<cv::Point2f> hull, both;
  cv::convexHull(points(a), hull);
  const double intersection = cv::intersectConvexConvex(hull, points(b), both);
  return intersection / (cv::contourArea(hull) + cv::contourArea(points(b)) - intersection);
}

Frame frame_with_disc(int index, double x) {
  cv::Mat image = cv::Mat::zeros(120, 160, CV_8UC1);
  constexpr int shift = 8;
  cv::circle(image, {static_cast<int>(std::lround(x * (1 << shift))), 60 << shift}, 15 << shift, 255, cv::FILLED, cv::LINE_8,
             shift);
  cv::GaussianBlur(image, image, {}, 0.8);
  Frame frame;
  frame.index = index;
  frame.time = timestamp_from_seconds(index / kRate);
  frame.image = Image(image);
  return frame;
}

TEST(PublishedOutline, FollowsABrightDiscOnDarkGround) {
  PublishedOutline outline({}, disc(30), disc(31));
  for (int k = 2; k < 60; ++k) {
    outline.step(frame_with_disc(k, 30 + k));
    const Outline& found = outline.outline();
    EXPECT_GT(overlap(geometry::ClosedSpline(found.order, found.control_points).polygon(), disc(30 + k)), 0.85) << k;
  }
  EXPECT_NEAR(outline.outline().velocity.x(), kRate, 5);
  PublishedOptions few, none;
  few.control_points = 3;
  none.lines = 0;
  EXPECT_THROW(PublishedOutline(few, disc(30), disc(31)), Error);
  EXPECT_THROW(PublishedOutline(none, disc(30), disc(31)), Error);
  EXPECT_THROW(PublishedOutline({}, {}, disc(31)), Error);
}

TEST(BoxFilter, FollowsABoxAndFreezesWhileItJumps) {
  const auto box = [](int k) { return Box{10.0 + 2 * k, 20.0 + k, 12, 30}; };
  BoxFilter filter({}, box(0), box(0).centre());
  for (int k = 1; k < 40; ++k) {
    const bool merged = k >= 20 && k < 25;
    const Box detected = merged ? Box{box(k).left, box(k).top, 40, 33} : box(k);
    filter.step(detected, detected.centre());
    EXPECT_EQ(filter.frozen(), merged) << k;
    if (k < 10) continue;
    EXPECT_GT(geometry::iou(filter.box(), box(k)), 0.85) << k;
    EXPECT_NEAR(filter.velocity().x(), 2, 0.3) << k;
  }
  filter.step(std::nullopt, std::nullopt);
  EXPECT_TRUE(filter.frozen());
  EXPECT_NEAR(filter.centre().x(), box(40).centre().x(), 0.5);
}

}  // namespace
}  // namespace marey::experiments
