#include "marey/evaluate/outline_overlap.h"

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace marey::evaluate {
namespace {

/// The obvious method: is each point of a large lattice inside?
bool inside(const std::vector<Vector<2>>& polygon, double x, double y) {
  bool odd = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector<2>& a = polygon[i];
    const Vector<2>& b = polygon[(i + 1) % polygon.size()];
    if ((a.y() <= y) != (b.y() <= y) && x < a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) odd = !odd;
  }
  return odd;
}

OutlineOverlap by_brute_force(const std::vector<Vector<2>>& polygon, const SilhouetteMask& truth, const cv::Size* image) {
  OutlineOverlap result;
  const double unit = 1.0 / (truth.samples * truth.samples);
  for (int row = -40 * truth.samples; row < 60 * truth.samples; ++row) {
    for (int column = -40 * truth.samples; column < 60 * truth.samples; ++column) {
      if (image != nullptr && !cv::Rect({0, 0}, *image * truth.samples).contains({column, row})) continue;
      const cv::Point in_mask = cv::Point(column, row) - truth.corner;
      const bool a = inside(polygon, (column + 0.5) / truth.samples - 0.5, (row + 0.5) / truth.samples - 0.5);
      const bool b = cv::Rect({0, 0}, truth.mask.size()).contains(in_mask) && truth.mask.at<std::uint8_t>(in_mask) != 0;
      result.outline += a ? unit : 0;
      result.silhouette += b ? unit : 0;
      result.shared += a && b ? unit : 0;
    }
  }
  return result;
}

TEST(OutlineOverlap, AgreesWithBruteForceOnRandomPolygons) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> location(-12, 32);
    std::vector<Vector<2>> polygon(3 + seed % 9);
    for (auto& corner : polygon) corner = {location(random), location(random)};
    SilhouetteMask truth;
    truth.samples = 1 + static_cast<int>(seed % 4);
    truth.corner = cv::Point(-3, 2) * truth.samples;
    truth.mask = cv::Mat::zeros(20 * truth.samples, 14 * truth.samples, CV_8UC1);
    for (int row = 0; row < truth.mask.rows; ++row) {
      for (int column = 0; column < truth.mask.cols; ++column)
        truth.mask.at<std::uint8_t>(row, column) = random() % 3 == 0 ? 0 : 255;
    }
    const cv::Size image(18, 21);
    for (const cv::Size* within : {static_cast<const cv::Size*>(nullptr), &image}) {
      const OutlineOverlap fast = overlap(polygon, truth, within);
      const OutlineOverlap slow = by_brute_force(polygon, truth, within);
      EXPECT_NEAR(fast.shared, slow.shared, 1e-9) << "seed " << seed;
      EXPECT_NEAR(fast.outline, slow.outline, 1e-9) << "seed " << seed;
      EXPECT_NEAR(fast.silhouette, slow.silhouette, 1e-9) << "seed " << seed;
    }
  }
}

TEST(OutlineOverlap, ASquareOfPixelsIsItself) {
  SilhouetteMask truth{cv::Mat(4, 6, CV_8UC1, cv::Scalar(255)), {2, 3}, 1};
  const std::vector<Vector<2>> edges{{1.5, 2.5}, {7.5, 2.5}, {7.5, 6.5}, {1.5, 6.5}};
  EXPECT_DOUBLE_EQ(overlap(edges, truth).iou(), 1);
  // A polygon through pixel centres loses a quarter of a pixel all round, and more.
  const std::vector<Vector<2>> centres{{2.01, 3.01}, {6.99, 3.01}, {6.99, 5.99}, {2.01, 5.99}};
  EXPECT_LT(overlap(centres, truth).iou(), 0.5);
}

TEST(OutlineOverlap, NothingOverlapsNothing) {
  EXPECT_EQ(overlap({}, SilhouetteMask{}).iou(), 0);
  const std::vector<Vector<2>> line{{0, 0}, {5, 5}};
  EXPECT_EQ(overlap(line, SilhouetteMask{cv::Mat(4, 4, CV_8UC1, cv::Scalar(255)), {0, 0}, 1}).shared, 0);
}

}  // namespace
}  // namespace marey::evaluate
