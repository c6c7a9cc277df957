#include "marey/calibrate/board/refine_corner.h"

#include <cmath>

#include <gtest/gtest.h>

#include "marey/calibrate/board/board_scene_test.h"

namespace marey::calibrate::board {
namespace {

constexpr int kPatchSide = 64;

/// Four squares that meet at `corner`, turned by `turn` rad, each pixel the mean of 8 × 8 places; grey levels 50 and 200.
cv::Mat four_squares(const Vector<2>& corner, double turn, Noise* noise = nullptr, double sigma = 0) {
  cv::Mat grey(kPatchSide, kPatchSide, CV_8UC1);
  for (int y = 0; y < kPatchSide; ++y) {
    for (int x = 0; x < kPatchSide; ++x) {
      int bright = 0;
      for (int i = 0; i < 64; ++i) {
        const Vector<2> d = Vector<2>(x - 0.5 + (i % 8 + 0.5) / 8, y - 0.5 + (i / 8 + 0.5) / 8) - corner;  // NOLINT
        const double u = std::cos(turn) * d.x() + std::sin(turn) * d.y(), v = -std::sin(turn) * d.x() + std::cos(turn) * d.y();
        bright += u * v > 0 ? 1 : 0;
      }
      const double level = 50 + 150 * bright / 64.0 + (noise != nullptr ? noise->gaussian(sigma) : 0);
      grey.at<unsigned char>(y, x) = cv::saturate_cast<unsigned char>(level);
    }
  }
  return grey;
}

/// One straight edge through the middle.
cv::Mat edge() {
  cv::Mat grey(kPatchSide, kPatchSide, CV_8UC1, cv::Scalar(50));
  grey.colRange(kPatchSide / 2, kPatchSide).setTo(200);
  return grey;
}

TEST(RefineCorner, FindsTheCornerToAFewHundredthsOfAPixel) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Noise noise(seed);
    const Vector<2> corner(32 + noise.uniform(-1, 1), 32 + noise.uniform(-1, 1));
    const cv::Mat grey = four_squares(corner, noise.uniform(-0.7, 0.7), &noise, 2);
    const auto found = refine_corner(grey, corner + Vector<2>(noise.uniform(-1.5, 1.5), noise.uniform(-1.5, 1.5)), 24);
    ASSERT_TRUE(found);
    EXPECT_LT((*found - corner).norm(), 0.06);
  }
}

TEST(RefineCorner, NoCornerIsNothing) {
  EXPECT_FALSE(refine_corner(edge(), {32, 32}, 20)) << "an edge runs one way";
  EXPECT_FALSE(refine_corner(cv::Mat(kPatchSide, kPatchSide, CV_8UC1, cv::Scalar(90)), {32, 32}, 20)) << "nothing at all";
  EXPECT_FALSE(refine_corner(four_squares({32, 32}, 0.2), {3, 3}, 20)) << "at the image's border";
  EXPECT_FALSE(refine_corner(four_squares({32, 32}, 0.2), {44, 20}, 20)) << "the corner is out of reach";
}

TEST(OppositeLikeness, TellsCornersFromEdges) {
  for (const double turn : {0.0, 0.3, 0.7}) EXPECT_GT(opposite_likeness(four_squares({32.3, 31.8}, turn), {32.3, 31.8}, 8), 0.9);
  EXPECT_LT(opposite_likeness(edge(), {31.5, 32}, 8), -0.8);
  EXPECT_EQ(opposite_likeness(cv::Mat(kPatchSide, kPatchSide, CV_8UC1, cv::Scalar(90)), {32, 32}, 8), 0) << "no contrast";
  EXPECT_EQ(opposite_likeness(four_squares({32, 32}, 0), {2, 2}, 8), 0) << "the image ends";
}

}  // namespace
}  // namespace marey::calibrate::board
