#include "marey/track/contour/colour/shared_region.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/geometry/bspline.h"
#include "marey/track/contour/colour/body_share.h"

namespace marey::track::contour::colour {
namespace {

constexpr int kWide = 120, kHigh = 100;

std::vector<Vector<2>> ellipse(const Vector<2>& centre, double across, double down) {
  std::vector<Vector<2>> polygon;
  for (int i = 0; i < 90; ++i) {
    const double angle = 2 * std::numbers::pi * i / 90;
    polygon.emplace_back(centre + Vector<2>(across * std::cos(angle), down * std::sin(angle)));
  }
  return polygon;
}

ColourPatch lawn() {
  ColourPatch patch;
  patch.colour = cv::Mat(kHigh, kWide, CV_32FC3, cv::Scalar(90, 110, 115));
  patch.mask = cv::Mat::zeros(kHigh, kWide, CV_32FC1);
  return patch;
}

void paint(ColourPatch& patch, const std::vector<Vector<2>>& polygon, const cv::Scalar& colour) {
  const cv::Mat within = cells_within(polygon, patch) > 0;
  patch.colour.setTo(colour, within);
  patch.mask.setTo(1, within);
}

double iou(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat both, either;
  cv::min(a, b, both);
  cv::max(a, b, either);
  return cv::sum(both)[0] / cv::sum(either)[0];
}

TEST(HalfLevelCurve, RunsWhereADiscEnds) {
  const ColourPatch patch = lawn();
  cv::Mat fraction(patch.size(), CV_32FC1);
  for (int y = 0; y < fraction.rows; ++y) {
    for (int x = 0; x < fraction.cols; ++x) {
      fraction.at<float>(y, x) = static_cast<float>(std::clamp(20.3 - std::hypot(x - 50.2, y - 44.7) + 0.5, 0.0, 1.0));
    }
  }
  const auto curve = half_level_curve(fraction, patch);
  EXPECT_NEAR(geometry::polygon_area(curve), std::numbers::pi * 20.3 * 20.3, 3) << "clockwise, so positive";
  for (const Vector<2>& point : curve) EXPECT_NEAR((point - Vector<2>(50.2, 44.7)).norm(), 20.3, 0.1);
  EXPECT_TRUE(half_level_curve(cv::Mat::zeros(patch.size(), CV_32FC1), patch).empty());
}

TEST(HalfLevelCurve, ClosesAtThePatchsBorderAndTakesTheLargest) {
  const ColourPatch patch = lawn();
  cv::Mat fraction = cv::Mat::zeros(patch.size(), CV_32FC1);
  fraction(cv::Rect(0, 0, 30, 30)) = 1;
  fraction(cv::Rect(60, 60, 8, 8)) = 1;
  EXPECT_NEAR(geometry::polygon_area(half_level_curve(fraction, patch)), 900, 2);
}

TEST(BodyShare, ABareLimbBetweenWhiteClothesIsBody) {
  ColourPatch patch = lawn();
  const cv::Rect shorts(50, 20, 16, 20), knee(55, 40, 5, 12), sock(55, 52, 5, 20);
  cv::Mat body = cv::Mat::zeros(patch.size(), CV_32FC1);
  for (const auto& [part, colour] : {std::pair(shorts, cv::Scalar(215, 128, 128)), std::pair(knee, cv::Scalar(100, 116, 138)),
                                     std::pair(sock, cv::Scalar(215, 128, 128))}) {
    patch.colour(part).setTo(colour);
    body(part) = 1;
  }
  patch.mask = body.clone();
  const cv::Mat fraction = body_fraction(patch, body, 60);
  EXPECT_GT(cv::mean(fraction(knee))[0], 0.8);
  EXPECT_NEAR(geometry::polygon_area(half_level_curve(fraction, patch)), cv::sum(body)[0], 0.1 * cv::sum(body)[0])
      << "in one piece";
}

TEST(BodyShare, ASilhouetteThatRunsOnTheHaloIsCutBackToTheBody) {
  ColourPatch patch = lawn();
  const auto body = ellipse({60, 50}, 12, 30);
  const auto halo = ellipse({60, 50}, 16, 34);
  paint(patch, halo, cv::Scalar(72, 110, 115));  // darker beside what is bright
  paint(patch, body, cv::Scalar(200, 128, 128));
  cv::GaussianBlur(patch.colour, patch.colour, {}, 0.8);
  const cv::Mat fraction = body_fraction(patch, cells_within(halo, patch), 60);
  cv::Mat covered;
  cv::Mat(fraction >= 0.5F).convertTo(covered, CV_32F, 1 / 255.0);
  EXPECT_GT(iou(covered, cells_within(body, patch)), 0.93);
  EXPECT_LT(iou(cells_within(halo, patch), cells_within(body, patch)), 0.7) << "what the silhouette alone says";
}

/// Two people, one in front of the other; the colours of each are known from before.
struct Pair {
  ColourPatch patch = lawn();
  std::vector<Vector<2>> front = ellipse({68, 54}, 12, 30), back = ellipse({54, 48}, 12, 30);
  BodyModel front_body, back_body;

  Pair(const cv::Scalar& front_colour, const cv::Scalar& back_colour) {
    for (const bool is_front : {true, false}) {
      ColourPatch alone = lawn();
      const auto& polygon = is_front ? front : back;
      paint(alone, polygon, is_front ? front_colour : back_colour);
      BodyModel& body = is_front ? front_body : back_body;
      const Vector<2> centre = is_front ? Vector<2>(68, 54) : Vector<2>(54, 48);
      body.learn_colours(alone, cells_within(polygon, alone), centre, 60, 1);
      body.learn_coverage(alone, cells_within(polygon, alone), centre, 60, 1);
    }
    paint(patch, back, back_colour);
    paint(patch, front, front_colour);
  }

  /// Both predicted `off` px from where they are.
  std::vector<RegionMember> members(const Vector<2>& off) const {
    std::vector<RegionMember> result(2);
    result[0].body = &back_body;
    result[0].polygon = back;
    result[0].centre = Vector<2>(54, 48) + off;
    result[1].body = &front_body;
    result[1].polygon = front;
    result[1].centre = Vector<2>(68, 54) - off;
    for (Vector<2>& corner : result[0].polygon) corner += off;
    for (Vector<2>& corner : result[1].polygon) corner -= off;
    for (RegionMember& member : result) {
      member.height = 60;
      member.foot = member.centre.y() + 30;
      member.shifts = {Vector<2>::Zero()};
    }
    return result;
  }
};

TEST(DivideRegion, EachGetsItsOwnPartAndTheHiddenPartKeepsItsShape) {
  const Pair pair(cv::Scalar(200, 128, 128), cv::Scalar(80, 160, 110));
  for (const double off : {0.0, 2.0, 5.0}) {
    auto members = pair.members({off, -off / 2});
    divide_region(pair.patch, members);
    const cv::Mat front = cells_within(pair.front, pair.patch), back = cells_within(pair.back, pair.patch);
    EXPECT_GT(iou(members[1].detected, front), 0.9) << off;
    EXPECT_GT(iou(members[0].detected, back.mul(1 - front)), 0.85) << off;
    EXPECT_GT(iou(members[0].whole, back), 0.85) << off;
    EXPECT_EQ(members[0].behind, std::vector<int>{1});
    EXPECT_TRUE(members[1].behind.empty());
    EXPECT_LT(members[0].visible, 0.9);
  }
}

TEST(DivideRegion, SameShirtsAreDividedByTheirShapes) {
  const Pair pair(cv::Scalar(200, 128, 128), cv::Scalar(200, 128, 128));
  auto members = pair.members({1, 0});
  divide_region(pair.patch, members);
  const cv::Mat front = cells_within(pair.front, pair.patch), back = cells_within(pair.back, pair.patch);
  EXPECT_GT(iou(members[1].detected, front), 0.8);
  EXPECT_GT(iou(members[0].whole, back), 0.75);
}

}  // namespace
}  // namespace marey::track::contour::colour
