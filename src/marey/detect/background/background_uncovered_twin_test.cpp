// The place that a person has left, against the slow method: every plane in floating point, medians by sorting.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/detect/background/background_uncovered.h"
#include "marey/detect/background/difference_sums.h"

namespace marey::detect::background {
namespace {

constexpr double kUnlikeLuma = 10, kUnlikeChroma = 7;  // levels: what differs by less is noise or shade
constexpr double kNoiseSigmas = 5;                     // deviations of the noise; likewise
constexpr double kOfGaussian = 1.4826;                 // standard deviations in a median distance from the median, of a Gaussian
constexpr double kMinArea = 0.15, kMaxArea = 2;        // of the body's box; with its shadow it is larger than the body
constexpr double kMinHeight = 0.5;                     // of the body's
constexpr double kGap = 1.0 / 15;                      // of the body's height: what is nearer together is one thing
constexpr double kSharper = 1.3, kSharperLevels = 2;   // how much sharper the border is in the scene, and by how many levels more
constexpr int kBlurReach = 2;                          // px about a region that its blur reaches

double middle_value(std::vector<float>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<float> values_of(const cv::Mat& plane, const cv::Mat& mask) {
  std::vector<float> values;
  for (int y = 0; y < plane.rows; ++y) {
    for (int x = 0; x < plane.cols; ++x) {
      if (mask.at<std::uint8_t>(y, x) != 0) values.push_back(plane.at<float>(y, x));
    }
  }
  return values;
}

/// Luma and, for colour, chroma at full size, 32 bit, in levels of 8 bit.
std::vector<cv::Mat> levels_of(const Image& image) {
  std::vector<cv::Mat> planes(1);
  image.luma().convertTo(planes[0], CV_32F, image.luma().depth() == CV_16U ? 1.0 / 257.0 : 1.0);
  if (!image.is_colour()) return planes;
  for (const cv::Mat* chroma : {&image.cb(), &image.cr()}) {
    cv::Mat full;
    cv::resize(*chroma, full, image.size(), 0, 0, cv::INTER_LINEAR);
    full.convertTo(planes.emplace_back(), CV_32F);
  }
  return planes;
}

cv::Rect pixels_of(const Box& box, cv::Size size) {
  const cv::Rect rect(cv::Point(static_cast<int>(std::floor(box.left)), static_cast<int>(std::floor(box.top))),
                      cv::Point(static_cast<int>(std::ceil(box.right())), static_cast<int>(std::ceil(box.bottom()))));
  return rect & cv::Rect({}, size);
}

cv::Mat round_element(int radius) {
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius + 1, 2 * radius + 1});
}

/// Where the two differ by more than the noise about the body does, once both are in one light.
cv::Mat differing(const std::vector<cv::Mat>& scene, const std::vector<cv::Mat>& now, const cv::Mat& outside) {
  cv::Mat mask = cv::Mat::zeros(scene.front().size(), CV_8UC1);
  for (std::size_t i = 0; i < scene.size(); ++i) {
    cv::Mat difference = now[i] - scene[i];
    cv::blur(difference, difference, {3, 3});
    std::vector<float> values = values_of(difference, outside);
    const double shade = middle_value(values);
    for (float& value : values) value = static_cast<float>(std::abs(value - shade));
    const double minimum = std::max(i == 0 ? kUnlikeLuma : kUnlikeChroma, kNoiseSigmas * kOfGaussian * middle_value(values));
    mask |= cv::abs(difference - shade) > minimum;
  }
  return mask;
}

/// How sharp the images are along a band, levels: of each pixel its sharpest plane.
double sharpness(const std::vector<cv::Mat>& planes, const cv::Mat& band) {
  cv::Mat sharpest = cv::Mat::zeros(band.size(), CV_32F);
  for (const cv::Mat& plane : planes) {
    cv::Mat smooth, gradient;
    cv::blur(plane, smooth, {3, 3});
    cv::morphologyEx(smooth, gradient, cv::MORPH_GRADIENT, round_element(1));
    sharpest = cv::max(sharpest, gradient);
  }
  return cv::mean(sharpest, band)[0];
}

/// Of the connected regions the one that has most pixels in the body's box; nothing if it is not a body.
std::optional<cv::Mat> region_at(const cv::Mat& mask, const Box& body) {
  cv::Mat labels, stats, centres;
  const int count = cv::connectedComponentsWithStats(mask, labels, stats, centres, 8);
  std::vector<int> within(static_cast<std::size_t>(count), 0);
  const cv::Rect box = pixels_of(body, mask.size());
  for (int y = box.y; y < box.br().y; ++y) {
    for (int x = box.x; x < box.br().x; ++x) ++within[static_cast<std::size_t>(labels.at<int>(y, x))];
  }
  within[0] = 0;
  const int best = static_cast<int>(std::max_element(within.begin(), within.end()) - within.begin());
  if (within[static_cast<std::size_t>(best)] == 0) return std::nullopt;
  const int area = stats.at<int>(best, cv::CC_STAT_AREA), height = stats.at<int>(best, cv::CC_STAT_HEIGHT);
  if (area < kMinArea * body.area() || area > kMaxArea * body.area() || height < kMinHeight * body.height) return std::nullopt;
  return cv::Mat(labels == best);
}

std::optional<cv::Mat> uncovered_slowly(const Image& scene, const Image& now, const Box& body) {
  if (scene.size() != now.size() || scene.is_colour() != now.is_colour() || scene.empty()) return std::nullopt;
  const std::vector<cv::Mat> before = levels_of(scene), after = levels_of(now);
  cv::Mat outside(scene.size(), CV_8UC1, cv::Scalar(255));
  outside(pixels_of(body, scene.size())) = 0;
  cv::Mat mask = differing(before, after, outside);
  const int gap = std::max(1, static_cast<int>(std::lround(kGap * body.height / 2)));
  cv::morphologyEx(mask, mask, cv::MORPH_OPEN, round_element(1));
  cv::morphologyEx(mask, mask, cv::MORPH_CLOSE, round_element(gap));
  auto region = region_at(mask, body);
  if (!region) return std::nullopt;
  cv::Mat outer, inner;
  cv::dilate(*region, outer, round_element(1));
  cv::erode(*region, inner, round_element(1));
  const cv::Mat band = outer & ~inner;
  if (sharpness(before, band) < kSharper * sharpness(after, band) + kSharperLevels) return std::nullopt;
  cv::dilate(*region, *region, round_element(kBlurReach));
  return region;
}

cv::Mat random_plane(std::mt19937& random, cv::Size size, double noise) {
  cv::Mat small(5, 6, CV_8UC1), plane;
  for (int y = 0; y < small.rows; ++y) {
    for (int x = 0; x < small.cols; ++x)
      small.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(std::uniform_int_distribution(60, 180)(random));
  }
  cv::resize(small, plane, size, 0, 0, cv::INTER_CUBIC);
  std::normal_distribution<double> of_noise(0, noise);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x)
      plane.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(plane.at<std::uint8_t>(y, x) + of_noise(random));
  }
  return plane;
}

cv::Mat noisy(std::mt19937& random, const cv::Mat& plane, double light) {
  cv::Mat result = plane.clone();
  std::normal_distribution<double> noise(0, 2);
  for (int y = 0; y < plane.rows; ++y) {
    for (int x = 0; x < plane.cols; ++x)
      result.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(light * plane.at<std::uint8_t>(y, x) + noise(random));
  }
  return result;
}

/// An image, and the same later: things stand in either of them.
struct Pair {
  Image scene, now;
};

Pair random_pair(std::mt19937& random, cv::Size size, const Box& body, bool colour, bool sixteen_bit) {
  std::vector<cv::Mat> before, after;
  const double light = std::uniform_real_distribution(0.8, 1.2)(random);
  const int which = std::uniform_int_distribution(0, 5)(random);
  for (int i = 0; i < (colour ? 3 : 1); ++i) {
    const cv::Size own = i == 0 ? size : cv::Size((size.width + 1) / 2, (size.height + 1) / 2);
    const cv::Mat ground = random_plane(random, own, which == 5 ? 40 : 3);
    before.push_back(noisy(random, ground, 1));
    after.push_back(noisy(random, ground, i == 0 ? light : 1));
    cv::Rect location = pixels_of(body, size);
    if (i > 0) location = cv::Rect(location.tl() / 2, location.size() / 2);
    const int level = std::uniform_int_distribution(0, 255)(random);
    if (which < 4) before.back()(location & cv::Rect({}, own)) = level;
    if (which == 3 || which == 4)
      after.back()(cv::Rect(location.x, location.y, location.width, location.height / 2) & cv::Rect({}, own)) = level;
  }
  if (sixteen_bit) after[0].convertTo(after[0], CV_16U, 256.7);
  if (!colour) return {Image(before[0]), Image(after[0])};
  return {{before[0], before[1], before[2], Image::Range::limited}, {after[0], after[1], after[2], Image::Range::limited}};
}

TEST(BackgroundUncoveredTwin, TheSamePlaceIsFound) {
  const unsigned seed = 20260;
  RecordProperty("seed", static_cast<int>(seed));
  std::mt19937 random(seed);
  int found = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const cv::Size size(2 * std::uniform_int_distribution(8, 90)(random), 2 * std::uniform_int_distribution(8, 90)(random));
    const double width = std::uniform_real_distribution(3.0, 0.7 * size.width)(random);
    const double height = std::uniform_real_distribution(5.0, 0.9 * size.height)(random);
    const Box body{std::uniform_real_distribution(-2.0, size.width - width)(random),
                   std::uniform_real_distribution(-2.0, size.height - height)(random), width, height};
    const Pair pair = random_pair(random, size, body, trial % 3 != 0, trial % 7 == 1 && trial % 3 == 0);
    const auto expected = uncovered_slowly(pair.scene, pair.now, body), got = uncovered(pair.scene, pair.now, body);
    ASSERT_EQ(expected.has_value(), got.has_value()) << "seed " << seed << ", trial " << trial;
    if (!expected) continue;
    ++found;
    ASSERT_EQ(cv::countNonZero(*expected != *got), 0) << "seed " << seed << ", trial " << trial;
  }
  EXPECT_GT(found, 60);
  EXPECT_LT(found, 340);
}

TEST(DifferenceSums, MedianDeviationAndMarksAreThoseOfTheSmoothedDifference) {
  const unsigned seed = 20261;
  RecordProperty("seed", static_cast<int>(seed));
  std::mt19937 random(seed);
  for (int trial = 0; trial < 300; ++trial) {
    const cv::Size size(std::uniform_int_distribution(1, 70)(random), std::uniform_int_distribution(1, 70)(random));
    const cv::Mat scene = random_plane(random, size, 0.5 + trial % 50), now = noisy(random, scene, 0.5 + trial % 10 * 0.1);
    const cv::Rect body = cv::Rect(std::uniform_int_distribution(0, 70)(random), std::uniform_int_distribution(0, 70)(random),
                                   std::uniform_int_distribution(0, 70)(random), std::uniform_int_distribution(0, 70)(random)) &
                          cv::Rect({}, size);
    cv::Mat outside(size, CV_8UC1, cv::Scalar(255)), before, after;
    outside(body) = 0;
    scene.convertTo(before, CV_32F);
    now.convertTo(after, CV_32F);
    cv::Mat difference = after - before;
    cv::blur(difference, difference, {3, 3});
    std::vector<float> values = values_of(difference, outside);
    const double shade = middle_value(values);
    for (float& value : values) value = static_cast<float>(std::abs(value - shade));
    const DifferenceSums sums(scene, now);
    const DifferenceSums::Noise noise = sums.noise_outside(body);
    ASSERT_EQ(noise.shade, shade) << "seed " << seed << ", trial " << trial;
    ASSERT_EQ(noise.deviation, middle_value(values)) << "seed " << seed << ", trial " << trial;
    const double minimum = std::uniform_real_distribution(0.0, 20.0)(random);
    cv::Mat mask = cv::Mat::zeros(size, CV_8UC1);
    sums.mark(shade, minimum, mask);
    ASSERT_EQ(cv::countNonZero(mask != (cv::abs(difference - shade) > minimum)), 0) << "seed " << seed << ", trial " << trial;
  }
}

}  // namespace
}  // namespace marey::detect::background
