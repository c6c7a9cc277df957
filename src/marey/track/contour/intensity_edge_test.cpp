#include "marey/track/contour/intensity_edge.h"

#include <cmath>

#include <gtest/gtest.h>

namespace marey::track::contour {
namespace {

constexpr double kRadius = 12.37;
const Vector<2> kCentre(30.21, 28.64);

/// A bright disc, every pixel by 8 × 8 samples.
cv::Mat disc() {
  cv::Mat luma(60, 60, CV_8UC1);
  for (int y = 0; y < luma.rows; ++y) {
    for (int x = 0; x < luma.cols; ++x) {
      int inside = 0;
      for (int i = 0; i < 64; ++i)
        inside += (Vector<2>(x - 0.4375 + i % 8 * 0.125, y - 0.4375 + i / 8 * 0.125) - kCentre).norm() < kRadius;
      luma.at<unsigned char>(y, x) = static_cast<unsigned char>(60 + 120 * inside / 64);
    }
  }
  return luma;
}

/// The edge of a mask that is `more` px too large, clockwise on the screen, a corner each degree.
std::vector<Vector<2>> around(double more) {
  std::vector<Vector<2>> polygon;
  for (int i = 0; i < 360; ++i) {
    const double angle = i * M_PI / 180;
    polygon.emplace_back(kCentre + (kRadius + more) * Vector<2>(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

double worst(const std::vector<Vector<2>>& points) {
  double result = 0;
  for (const Vector<2>& point : points) result = std::max(result, std::abs((point - kCentre).norm() - kRadius));
  return result;
}

TEST(LightEdge, AnEdgeOfLightDrawsTheSilhouetteTowardsIt) {
  for (const double more : {-0.8, -0.4, 0.0, 0.5, 0.9}) {
    const auto moved = moved_to_intensity_edges(around(more), disc());
    EXPECT_NEAR(static_cast<double>(moved.size()), 2 * M_PI * (kRadius + more), 2);
    EXPECT_LT(worst(moved), 0.45 * std::abs(more) + 0.2) << more;
  }
}

TEST(LightEdge, WithoutLightTheSilhouetteStands) {
  EXPECT_LT(worst(moved_to_intensity_edges(around(0), cv::Mat(60, 60, CV_8UC1, cv::Scalar(90)))), 0.01);
  EXPECT_EQ(moved_to_intensity_edges(around(0), {}).size(), 360u);
  EXPECT_TRUE(moved_to_intensity_edges({}, disc()).empty());
  const std::vector<Vector<2>> pixel = {{1.5, 1.5}, {2.5, 1.5}, {2.5, 2.5}, {1.5, 2.5}};
  EXPECT_EQ(moved_to_intensity_edges(pixel, disc()).size(), 4u) << "too short to have a normal";
}

TEST(LightEdge, BeyondThePictureNothingIsRead) {
  std::vector<Vector<2>> polygon = around(0);
  for (Vector<2>& corner : polygon) corner.x() -= 40;
  for (const Vector<2>& point : moved_to_intensity_edges(polygon, disc())) EXPECT_TRUE(point.allFinite());
}

}  // namespace
}  // namespace marey::track::contour
