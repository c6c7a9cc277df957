#include "marey/detect/background/background_even.h"

#include <cstdlib>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace marey::detect::background {
namespace {

constexpr int kEvenBlack = 16;
const cv::Rect kEvenInner(40, 40, 240, 160);

cv::Mat tiles(std::uint32_t seed) {
  std::mt19937 random(seed);
  cv::Mat coarse(60, 80, CV_8UC1), fine;
  for (int i = 0; i < static_cast<int>(coarse.total()); ++i) coarse.data[i] = static_cast<std::uint8_t>(70 + random() % 70);
  cv::resize(coarse, fine, {320, 240}, 0, 0, cv::INTER_NEAREST);
  return fine;
}

/// The ground in `gain` times the light left of `edge`.
cv::Mat shaded(const cv::Mat& ground, int edge, double gain) {
  cv::Mat result = ground.clone();
  cv::Mat part = result.colRange(0, edge);
  part.convertTo(part, CV_8U, gain, kEvenBlack * (1 - gain));
  return result;
}

double greatest_spread(const std::vector<FramePlanes>& samples, const cv::Rect& where) {
  cv::Mat low = samples.front().luma(where).clone(), high = low.clone();
  for (const FramePlanes& sample : samples) {
    cv::min(low, sample.luma(where), low);
    cv::max(high, sample.luma(where), high);
  }
  return cv::mean(high - low)[0];
}

TEST(EvenedOut, SamplesUnderACloudAreOneScene) {
  const cv::Mat ground = tiles(1);
  std::vector<FramePlanes> samples;
  for (int i = 0; i < 9; ++i) samples.push_back({shaded(ground, 40 + 30 * i, 0.6), {}, {}});
  const auto evened = evened_out(samples, kEvenBlack);
  ASSERT_TRUE(evened);
  EXPECT_LT(greatest_spread(*evened, kEvenInner), 0.4 * greatest_spread(samples, kEvenInner));
}

TEST(EvenedOut, SamplesOfACameraThatShakesAreOneScene) {
  const cv::Mat ground = tiles(2);
  std::vector<FramePlanes> samples;
  for (int i = 0; i < 9; ++i) {
    const cv::Mat by = (cv::Mat_<double>(2, 3) << 1, 0, i % 3 * 3 - 3, 0, 1, i % 4 * 2 - 3);
    cv::Mat moved;
    cv::warpAffine(ground, moved, by, ground.size(), cv::INTER_NEAREST, cv::BORDER_REPLICATE);
    samples.push_back({moved, {}, {}});
  }
  const auto evened = evened_out(samples, kEvenBlack);
  ASSERT_TRUE(evened);
  EXPECT_LT(greatest_spread(*evened, kEvenInner), 1);
}

TEST(EvenedOut, KeepsImageIfOnlyPeopleMove) {
  const cv::Mat ground = tiles(3);
  std::vector<FramePlanes> samples;
  for (int i = 0; i < 9; ++i) {
    cv::Mat with = ground.clone();
    with({20 + 30 * i, 60, 24, 80}).setTo(60);
    samples.push_back({with, {}, {}});
  }
  EXPECT_FALSE(evened_out(samples, kEvenBlack));
}

TEST(EvenedOut, FewSamplesOrOthersThanTheSceneAreLeft) {
  EXPECT_FALSE(evened_out({}, kEvenBlack));
  std::vector<FramePlanes> samples;
  for (std::uint32_t i = 0; i < 9; ++i) samples.push_back({tiles(i), {}, {}});
  EXPECT_FALSE(evened_out(samples, kEvenBlack));
  samples.resize(3);
  EXPECT_FALSE(evened_out(samples, kEvenBlack));
}

}  // namespace
}  // namespace marey::detect::background
