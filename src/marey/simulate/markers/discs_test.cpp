#include "marey/simulate/markers/discs.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace marey::simulate::markers {
namespace {

TEST(Discs, APixelIsTheFormulaAveragedOverSixtyFourPoints) {
  const Disc disc{{10.3, 7.8}, 2.0, 202, 0.55};
  cv::Mat image(16, 20, CV_32FC1, cv::Scalar(12));
  draw_discs(image, std::span(&disc, 1));
  for (const cv::Point pixel : {cv::Point(10, 8), cv::Point(12, 8), cv::Point(9, 6), cv::Point(13, 9), cv::Point(0, 0)}) {
    double sum = 0;
    for (int j = 0; j < 8; ++j) {
      for (int i = 0; i < 8; ++i) {
        const double d = std::hypot(pixel.x - 0.4375 + i / 8.0 - 10.3, pixel.y - 0.4375 + j / 8.0 - 7.8);
        sum += 12 + 190 * 0.5 * std::erfc((d - 2.0) / (std::sqrt(2.0) * 0.55));
      }
    }
    EXPECT_NEAR(image.at<float>(pixel), sum / 64, 1e-4) << pixel;
  }
}

TEST(Discs, DiscsBeyondTheEdgeAreCutAndDiscsOutsideLeaveNoTrace) {
  cv::Mat image(8, 8, CV_32FC1, cv::Scalar(12));
  const std::array<Disc, 2> discs{Disc{{-100, 3}, 4}, Disc{{7.5, 7.5}, 3}};
  draw_discs(image, discs);
  EXPECT_FLOAT_EQ(image.at<float>(0, 0), 12);
  EXPECT_GT(image.at<float>(7, 7), 190);
}

TEST(Discs, ABarrierHidesWhatItCovers) {
  cv::Mat image(6, 6, CV_32FC1, cv::Scalar(100));
  draw_barrier(image, {1.5, 2, 2, 3}, 0);
  EXPECT_FLOAT_EQ(image.at<float>(3, 1), 50);
  EXPECT_FLOAT_EQ(image.at<float>(3, 2), 0);
  EXPECT_FLOAT_EQ(image.at<float>(3, 3), 50);
  EXPECT_FLOAT_EQ(image.at<float>(1, 2), 100);
  EXPECT_FLOAT_EQ(image.at<float>(5, 2), 100);
}

TEST(Discs, NoiseHasItsDeviationAndFollowsItsSeed) {
  const cv::Mat flat(200, 200, CV_32FC1, cv::Scalar(100));
  cv::Scalar mean, deviation;
  cv::meanStdDev(expose(flat, 3, 1), mean, deviation);
  EXPECT_NEAR(mean[0], 100, 0.1);
  EXPECT_NEAR(deviation[0], std::sqrt(9 + 1.0 / 12), 0.1);
  EXPECT_EQ(cv::norm(expose(flat, 3, 7), expose(flat, 3, 7), cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(expose(flat, 3, 7), expose(flat, 3, 8), cv::NORM_INF), 0);
}

TEST(Discs, TheBoundFollowsTheEdgeThatTheDiscShows) {
  // For a disc much wider than its blur s, information per axis is contrast² · π R / (2 s √π), whatever the other unknowns are.
  const double s = std::hypot(1.0, std::sqrt(1.0 / 12));
  const double expected = 3.0 / std::sqrt(190.0 * 190.0 * M_PI * 8 / (2 * s * std::sqrt(M_PI)));
  EXPECT_NEAR(disc_centre_bound({{0, 0}, 8, 202, 1.0}, 12, 3), expected, 0.02 * expected);
}

}  // namespace
}  // namespace marey::simulate::markers
