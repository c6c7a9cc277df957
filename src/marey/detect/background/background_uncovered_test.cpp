#include "marey/detect/background/background_uncovered.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace marey::detect::background {
namespace {

constexpr int kWidth = 96, kHeight = 80;
const Box kBody{36, 20, 16, 40};

/// A ground with a texture and noise; with a figure on it where it is asked for.
Image ground(int seed, double light, const Box& figure) {
  cv::Mat luma(kHeight, kWidth, CV_32F);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) luma.at<float>(y, x) = 110 + 10 * std::sin(0.3F * x) * std::cos(0.2F * y);
  }
  const cv::Rect body(static_cast<int>(figure.left), static_cast<int>(figure.top), static_cast<int>(figure.width),
                      static_cast<int>(figure.height));
  if (!body.empty()) luma(body) = 60;
  cv::Mat noise(kHeight, kWidth, CV_32F);
  cv::RNG random(static_cast<std::uint64_t>(seed));
  random.fill(noise, cv::RNG::NORMAL, 0, 2);
  cv::Mat levels;
  luma = light * luma + noise;
  luma.convertTo(levels, CV_8U);
  const cv::Mat chroma(kHeight / 2, kWidth / 2, CV_8UC1, cv::Scalar(128));
  return {levels, chroma, chroma.clone(), Image::Range::limited};
}

double covered(const cv::Mat& mask) {
  const cv::Mat inside = mask(cv::Rect(36, 20, 16, 40));
  return static_cast<double>(cv::countNonZero(inside)) / static_cast<double>(inside.total());
}

TEST(BackgroundUncovered, APlaceThatHasLostItsOutlineIsFound) {
  for (const double light : {0.9, 1.0, 1.1}) {
    const auto gone = uncovered(ground(1, 1, kBody), ground(2, light, {}), kBody);
    ASSERT_TRUE(gone) << light;
    EXPECT_GT(covered(*gone), 0.95);
    EXPECT_LT(cv::countNonZero(*gone), 2 * kBody.area());
  }
}

TEST(BackgroundUncovered, PersonStandingThereHasNotLeft) {
  EXPECT_FALSE(uncovered(ground(1, 1, {}), ground(2, 1, kBody), kBody));
  EXPECT_FALSE(uncovered(ground(1, 1, {}), ground(2, 1, {}), kBody)) << "nothing was there";
  EXPECT_FALSE(uncovered(ground(1, 1, kBody), ground(2, 1, kBody), kBody)) << "it still is";
  EXPECT_FALSE(uncovered(ground(1, 1, {10, 4, 80, 70}), ground(2, 1, {}), kBody)) << "too large: a car";
}

TEST(BackgroundUncovered, APictureIsPatchedInItsOwnLight) {
  const Image with = ground(1, 1.1, kBody), without = ground(2, 1, {});
  const cv::Mat mask = *uncovered(ground(3, 1, kBody), without, kBody);
  const Image patch = patched(with, without, mask, {0, 0});
  const double bright = cv::mean(ground(4, 1.1, {}).luma()(cv::Rect(36, 20, 16, 40)))[0];
  EXPECT_NEAR(cv::mean(patch.luma()(cv::Rect(36, 20, 16, 40)))[0], bright, 4);
  EXPECT_TRUE(same_within(patch, ground(5, 1.1, {}), mask));
  EXPECT_FALSE(same_within(with, ground(5, 1.1, {}), mask));
  EXPECT_NE(with.luma().at<std::uint8_t>(40, 44), patch.luma().at<std::uint8_t>(40, 44)) << "the image given stays";
}

}  // namespace
}  // namespace marey::detect::background
