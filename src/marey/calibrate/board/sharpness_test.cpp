#include "marey/calibrate/board/sharpness.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace marey::calibrate::board {
namespace {

/// Squares of 20 px, and the corners where four meet.
cv::Mat squares() {
  cv::Mat grey(200, 200, CV_8UC1);
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) grey.at<unsigned char>(y, x) = (x / 20 + y / 20) % 2 == 0 ? 30 : 220;
  }
  return grey;
}

BoardView corners() {
  BoardView view;
  for (int i = 1; i < 9; ++i) view.corners.push_back({i, {20.0 * i - 0.5, 99.5}});
  return view;
}

cv::Mat blurred(double sigma) {
  cv::Mat result;
  cv::GaussianBlur(squares(), result, {}, sigma);
  return result;
}

TEST(Sharpness, FallsAsEdgesAreSmeared) {
  const double sharp = sharpness_of(Image(squares()), corners());
  EXPECT_NEAR(sharp, 1, 1e-9) << "a step from one pixel to the next";
  double before = sharp;
  for (const double sigma : {0.7, 1.5, 3.0}) {
    const double here = sharpness_of(Image(blurred(sigma)), corners());
    EXPECT_LT(here, 0.8 * before) << sigma;
    before = here;
  }
  EXPECT_NEAR(sharpness_of(Image(blurred(1.5)), corners()), 1 / (1.5 * std::sqrt(2 * M_PI)), 0.08) << "a Gaussian edge's slope";
}

TEST(Sharpness, SixteenBitsAreNoDifferent) {
  cv::Mat deep;
  blurred(1).convertTo(deep, CV_16U, 257);
  EXPECT_NEAR(sharpness_of(Image(deep), corners()), sharpness_of(Image(blurred(1)), corners()), 1e-9);
}

TEST(Sharpness, ContrastDoesNotCount) {
  cv::Mat faint;
  squares().convertTo(faint, CV_8U, 0.2, 90);
  EXPECT_NEAR(sharpness_of(Image(faint), corners()), 1, 1e-9);
}

TEST(Sharpness, NothingToSeeIsZero) {
  EXPECT_EQ(sharpness_of(Image(cv::Mat(200, 200, CV_8UC1, cv::Scalar(90))), corners()), 0);
  EXPECT_EQ(sharpness_of(Image(squares()), {}), 0);
  BoardView at_the_border;
  at_the_border.corners.push_back({0, {1, 1}});
  EXPECT_EQ(sharpness_of(Image(squares()), at_the_border), 0);
}

}  // namespace
}  // namespace marey::calibrate::board
