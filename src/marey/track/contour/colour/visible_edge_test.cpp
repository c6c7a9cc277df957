#include "marey/track/contour/colour/visible_edge.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace marey::track::contour::colour {
namespace {

constexpr double kPrior = 3;

geometry::ClosedSpline round_curve(const Vector<2>& centre, double radius) {
  std::vector<Vector<2>> points;
  for (int i = 0; i < 16; ++i) {
    const double angle = 2 * std::numbers::pi * i / 16;
    points.emplace_back(centre + radius * Vector<2>(std::cos(angle), std::sin(angle)));
  }
  return {4, std::move(points)};
}

/// A disc of this luma on a lawn.
ColourPatch disc_on_lawn(double luma) {
  ColourPatch patch;
  patch.colour = cv::Mat(80, 100, CV_32FC3, cv::Scalar(90, 110, 115));
  patch.mask = cv::Mat::zeros(80, 100, CV_32FC1);
  const cv::Mat inside = cells_within(round_curve({50, 40}, 20).polygon(), patch) > 0;
  patch.colour.setTo(cv::Scalar(luma, 110, 115), inside);
  return patch;
}

TEST(VisibleEdge, IsKnownBetterTheMoreItDiffers) {
  const auto curve = round_curve({50, 40}, 20);
  const VisibleEdge clear = visible_edge(curve, disc_on_lawn(190), {}, {100, 80}, kPrior),
                    weak = visible_edge(curve, disc_on_lawn(105), {}, {100, 80}, kPrior);
  EXPECT_TRUE(clear.hidden.empty());
  EXPECT_TRUE(weak.hidden.empty());
  for (std::size_t i = 0; i < clear.deviations.size(); ++i) EXPECT_LT(clear.deviations[i], weak.deviations[i]);
  EXPECT_EQ(visible_edge(curve, disc_on_lawn(92), {}, {100, 80}, kPrior).hidden.size(), 16U);
}

TEST(VisibleEdge, IsHiddenByAnotherBody) {
  const auto curve = round_curve({50, 40}, 20);
  const ColourPatch patch = disc_on_lawn(190);
  cv::Mat blocked = cv::Mat::zeros(patch.size(), CV_32FC1);
  blocked.colRange(60, 100).setTo(1);
  const VisibleEdge edge = visible_edge(curve, patch, blocked, {100, 80}, kPrior);
  EXPECT_FALSE(edge.hidden.empty());
  for (int i = 0; i < curve.count(); ++i) {
    const bool hidden = std::binary_search(edge.hidden.begin(), edge.hidden.end(), i);
    EXPECT_EQ(edge.deviations[static_cast<std::size_t>(i)] == kPrior, hidden);
    const double x = curve.at(i).x();
    EXPECT_TRUE(hidden || x <= 62) << x;
    EXPECT_TRUE(!hidden || x >= 56) << x;
  }
}

TEST(VisibleEdge, EndsAtTheBorderOfTheImage) {
  const auto curve = round_curve({19.5, 40}, 20);
  const std::vector<int> hidden = at_border(curve, {100, 80});
  ASSERT_FALSE(hidden.empty());
  for (const int i : hidden) EXPECT_LT(curve.at(i).x(), 2);
  EXPECT_TRUE(at_border(round_curve({50, 40}, 20), {100, 80}).empty());
}

TEST(VisibleEdge, IsNotWhereTheSceneHidesTheBody) {
  const auto curve = round_curve({50, 40}, 20);
  ColourPatch patch = disc_on_lawn(190);
  patch.scene = cv::Mat(patch.size(), CV_32FC3, cv::Scalar(90, 110, 115));
  patch.known = cv::Mat::ones(patch.size(), CV_32FC1);
  EXPECT_TRUE(visible_edge(curve, patch, {}, {100, 80}, kPrior).hidden.empty());
  // A board, whose upper edge is where the body ends.
  for (cv::Mat* const one : {&patch.scene, &patch.colour}) one->rowRange(59, 80).setTo(cv::Scalar(30, 128, 128));
  const VisibleEdge edge = visible_edge(curve, patch, {}, {100, 80}, kPrior);
  ASSERT_FALSE(edge.hidden.empty());
  for (const int i : edge.hidden) EXPECT_GT(curve.at(i).y(), 50);
}

}  // namespace
}  // namespace marey::track::contour::colour
