#include "marey/detect/markers/marker_runs.h"

#include <algorithm>
#include <chrono>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "marey/detect/kernel_targets.h"

namespace marey::detect::markers {
namespace {

struct Region {
  cv::Rect box;
  std::int64_t area = 0;
  double sum_x = 0, sum_y = 0;
};

/// The slow twin: flood fill, pixel by pixel.
std::vector<Region> flood(const cv::Mat& image, const MarkerThresholds& thresholds) {
  const int words = (image.cols + 63) / 64;
  const auto passes = [&](int x, int y) {
    const int value = image.depth() == CV_8U ? image.at<std::uint8_t>(y, x) : image.at<std::uint16_t>(y, x);
    const int limit = thresholds.of_tile[static_cast<std::size_t>(y / 64) * words + x / 64];
    return thresholds.dark ? value < limit : value > limit;
  };
  cv::Mat detected = cv::Mat::zeros(image.size(), CV_8U);
  std::vector<Region> regions;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      if (!passes(x, y) || detected.at<std::uint8_t>(y, x) != 0) continue;
      Region region{{x, y, 1, 1}};
      std::vector<cv::Point> open{{x, y}};
      detected.at<std::uint8_t>(y, x) = 1;
      while (!open.empty()) {
        const cv::Point p = open.back();
        open.pop_back();
        region.box |= cv::Rect(p.x, p.y, 1, 1);
        ++region.area;
        region.sum_x += p.x;
        region.sum_y += p.y;
        for (int j = std::max(0, p.y - 1); j <= std::min(image.rows - 1, p.y + 1); ++j) {
          for (int i = std::max(0, p.x - 1); i <= std::min(image.cols - 1, p.x + 1); ++i) {
            if (!passes(i, j) || detected.at<std::uint8_t>(j, i) != 0) continue;
            detected.at<std::uint8_t>(j, i) = 1;
            open.emplace_back(i, j);
          }
        }
      }
      regions.push_back(region);
    }
  }
  return regions;
}

void expect_same(std::span<const MarkerBlob> blobs, const std::vector<Region>& regions) {
  ASSERT_EQ(blobs.size(), regions.size());
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const auto n = static_cast<double>(regions[i].area);
    EXPECT_EQ(blobs[i].area, regions[i].area);
    EXPECT_EQ(blobs[i].box, regions[i].box);
    EXPECT_NEAR(blobs[i].mean_x, regions[i].sum_x / n, 1e-9);
    EXPECT_NEAR(blobs[i].mean_y, regions[i].sum_y / n, 1e-9);
  }
}

MarkerThresholds everywhere(cv::Size size, int threshold, bool dark = false) {
  const int tiles = (size.width + 63) / 64 * ((size.height + 63) / 64);
  return {std::vector<std::uint16_t>(tiles, static_cast<std::uint16_t>(threshold)), dark};
}

TEST(MarkerRuns, AgreeWithFloodFillOnRandomImagesAtEveryProcessorLevel) {
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const cv::Size size(1 + random() % 200, 1 + random() % 150);
    const int depth = seed % 2 == 0 ? CV_8U : CV_16U;
    const unsigned top = depth == CV_8U ? 256 : 65536;
    cv::Mat whole(size.height, size.width + 7, CV_MAKETYPE(depth, 1));
    const cv::Mat image = whole(cv::Rect(random() % 7, 0, size.width, size.height));  // rows that begin anywhere
    for (int y = 0; y < whole.rows; ++y) {
      for (int x = 0; x < whole.cols; ++x) {
        if (depth == CV_8U) whole.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(random() % top);
        if (depth == CV_16U) whole.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(random() % top);
      }
    }
    MarkerThresholds thresholds = everywhere(size, 0, seed % 3 == 0);
    const double level = 0.02 + 0.96 * (seed % 10) / 10.0;
    for (auto& threshold : thresholds.of_tile)
      threshold = static_cast<std::uint16_t>(top * (0.9 * level + random() % 100 / 1000.0));
    const auto regions = flood(image, thresholds);
    for (const auto& [target, kernels] : kernels_of_every_target(marker_kernels)) {
      SCOPED_TRACE(target);
      MarkerRunFinder finder(1 << 20, *kernels);
      expect_same(finder.find(image, thresholds, {}), regions);
    }
  }
}

TEST(MarkerRuns, ExtremeThresholdsPassNothingOrEverything) {
  const cv::Mat white(70, 130, CV_8UC1, cv::Scalar(255));
  MarkerRunFinder finder(1 << 16);
  EXPECT_TRUE(finder.find(white, everywhere(white.size(), 255), {}).empty());
  EXPECT_TRUE(finder.find(white, everywhere(white.size(), 255, true), {}).empty());
  const auto all = finder.find(white, everywhere(white.size(), 254), {});
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].area, 70 * 130);
  EXPECT_NEAR(all[0].var_x, 130 * 130 / 12.0, 1e-9);
  EXPECT_NEAR(all[0].var_y, 70 * 70 / 12.0, 1e-9);
  EXPECT_EQ(finder.find(cv::Mat(1, 1, CV_16UC1, cv::Scalar(65535)), everywhere({1, 1}, 65534), {}).size(), 1u);
}

TEST(MarkerRuns, ACheckerboardIsOneComponentAndTooManyRunsEndTheSearch) {
  cv::Mat board(600, 800, CV_8UC1);
  for (int y = 0; y < board.rows; ++y) {
    for (int x = 0; x < board.cols; ++x) board.at<std::uint8_t>(y, x) = (x + y) % 2 == 0 ? 255 : 0;
  }
  MarkerRunFinder roomy(1 << 20);
  EXPECT_EQ(roomy.find(board, everywhere(board.size(), 100), {}).size(), 1u);
  EXPECT_FALSE(roomy.cut_at());
  MarkerRunFinder tight(10000);
  tight.find(board, everywhere(board.size(), 100), {});
  EXPECT_LE(tight.runs().size(), 10000u);
  ASSERT_TRUE(tight.cut_at());
  EXPECT_NEAR(*tight.cut_at(), 25, 2);
}

TEST(MarkerRuns, MaskedPixelsAreLeftOut) {
  cv::Mat image = cv::Mat::zeros(20, 100, CV_8U);
  image(cv::Rect(60, 5, 10, 4)).setTo(200);
  cv::Mat excluded = cv::Mat::zeros(20, 100, CV_8U);
  excluded(cv::Rect(63, 0, 3, 20)).setTo(255);
  MarkerRunFinder finder(1000);
  const auto blobs = finder.find(image, everywhere(image.size(), 100), MarkerMask(excluded));
  ASSERT_EQ(blobs.size(), 2u);
  EXPECT_EQ(blobs[0].box, cv::Rect(60, 5, 3, 4));
  EXPECT_EQ(blobs[1].box, cv::Rect(66, 5, 4, 4));
}

}  // namespace
}  // namespace marey::detect::markers
