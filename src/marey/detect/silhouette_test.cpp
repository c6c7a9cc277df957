#include "marey/detect/silhouette.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/detect/runs.h"

namespace marey::detect {
namespace {

cv::Mat random_mask(std::mt19937& random, int width, int height, double density) {
  cv::Mat mask(height, width, CV_8UC1);
  std::bernoulli_distribution set(density);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) mask.at<std::uint8_t>(y, x) = set(random) ? 255 : 0;
  }
  return mask;
}

/// The slow twin of hole filling: floods the background from the border, edge by edge.
cv::Mat filled(const cv::Mat& mask) {
  cv::Mat open;
  cv::copyMakeBorder(mask, open, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::floodFill(open, cv::Point(0, 0), cv::Scalar(128), nullptr, 0, 0, 4);
  cv::Mat result = open != 128;
  return result(cv::Rect(1, 1, mask.cols, mask.rows)).clone();
}

std::set<std::pair<int, int>> pixels_of(const Region& region) {
  std::set<std::pair<int, int>> pixels;
  for (const PixelRun& run : region.runs) {
    for (int x = run.begin; x < run.end; ++x) pixels.emplace(run.row, x);
  }
  return pixels;
}

double shoelace(const std::vector<Vector<2>>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector<2>& a = polygon[i];
    const Vector<2>& b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - b.x() * a.y();
  }
  return twice / 2;
}

class RandomMasks : public testing::TestWithParam<int> {
 protected:
  cv::Mat next() {
    const double density = std::uniform_real_distribution<double>(0.05, 0.95)(random_);
    return random_mask(random_, std::uniform_int_distribution<int>(1, 40)(random_),
                       std::uniform_int_distribution<int>(1, 30)(random_), density);
  }

  std::mt19937 random_{static_cast<unsigned>(GetParam())};
};

TEST_P(RandomMasks, RegionsAreOpenCvsComponents) {
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", round " << round);
    const cv::Mat mask = next();
    cv::Mat labels, stats, centres;
    const int count = cv::connectedComponentsWithStats(mask, labels, stats, centres, 8);
    const std::vector<Region> regions = find_regions(mask, {.min_area = 1, .max_hole = 0});
    ASSERT_EQ(regions.size(), static_cast<std::size_t>(count - 1));
    for (const Region& region : regions) {
      const int label = labels.at<int>(region.runs.front().row, region.runs.front().begin);
      ASSERT_GT(label, 0);
      const auto stat = [&](int column) { return stats.at<int>(label, column); };
      EXPECT_EQ(region.area, stat(cv::CC_STAT_AREA));
      const Box box{static_cast<double>(stat(cv::CC_STAT_LEFT)), static_cast<double>(stat(cv::CC_STAT_TOP)),
                    static_cast<double>(stat(cv::CC_STAT_WIDTH)), static_cast<double>(stat(cv::CC_STAT_HEIGHT))};
      EXPECT_EQ(region.box, box);
      EXPECT_NEAR(region.centre.x(), centres.at<double>(label, 0), 1e-9);
      EXPECT_NEAR(region.centre.y(), centres.at<double>(label, 1), 1e-9);
      for (const auto& [row, column] : pixels_of(region)) ASSERT_EQ(labels.at<int>(row, column), label);
    }
  }
}

TEST_P(RandomMasks, HolesAreFilledAsByFlooding) {
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", round " << round);
    const cv::Mat mask = next();
    cv::Mat drawn = cv::Mat::zeros(mask.size(), CV_8UC1);
    for (const Region& region : find_regions(mask)) {
      for (const PixelRun& run : region.runs) drawn.row(run.row).colRange(run.begin, run.end) = 255;
    }
    EXPECT_EQ(cv::countNonZero(drawn != filled(mask)), 0);
  }
}

TEST_P(RandomMasks, OutlineEnclosesThePixelsOfTheRegion) {
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", round " << round);
    for (const Region& region : find_regions(next())) {
      const std::vector<Vector<2>> outline = outline_of(region.runs);
      ASSERT_GE(outline.size(), 4U);
      EXPECT_EQ(shoelace(outline), region.area);
      double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
      for (std::size_t i = 0; i < outline.size(); ++i) {
        const Vector<2> step = outline[(i + 1) % outline.size()] - outline[i];
        EXPECT_TRUE((step.x() == 0) != (step.y() == 0)) << "edges are upright or level";
        const Vector<2> next_step = outline[(i + 2) % outline.size()] - outline[(i + 1) % outline.size()];
        EXPECT_EQ(step.dot(next_step), 0) << "a corner turns";
        left = std::min(left, outline[i].x());
        right = std::max(right, outline[i].x());
        top = std::min(top, outline[i].y());
        bottom = std::max(bottom, outline[i].y());
      }
      EXPECT_EQ((Box{left + 0.5, top + 0.5, right - left, bottom - top}), region.box);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomMasks, testing::Values(1, 2, 3, 4));

TEST(Silhouette, SmallRegionsAndLargeHolesAreLeftAsAsked) {
  cv::Mat mask = cv::Mat::zeros(20, 30, CV_8UC1);
  cv::rectangle(mask, {2, 2}, {11, 11}, 255, 1);  // a ring: 36 pixels round a hole of 64
  mask.at<std::uint8_t>(15, 20) = 255;
  EXPECT_EQ(find_regions(mask, {.min_area = 2, .max_hole = 63}).front().area, 36);
  EXPECT_EQ(find_regions(mask, {.min_area = 2, .max_hole = 64}).front().area, 100);
  EXPECT_EQ(find_regions(mask, {.min_area = 2}).size(), 1U);
  EXPECT_EQ(find_regions(mask, {.min_area = 1}).size(), 2U);
  EXPECT_TRUE(find_regions(cv::Mat::zeros(3, 3, CV_8UC1)).empty());
  EXPECT_TRUE(find_regions(cv::Mat()).empty());
}

TEST(Silhouette, PixelIsSquareAroundCentre) {
  const std::vector<PixelRun> runs = {{3, 5, 6}};
  const std::vector<Vector<2>> outline = outline_of(runs);
  ASSERT_EQ(outline.size(), 4U);
  EXPECT_EQ(outline[0], Vector<2>(4.5, 2.5));
  EXPECT_EQ(outline[1], Vector<2>(5.5, 2.5));
  EXPECT_EQ(outline[2], Vector<2>(5.5, 3.5));
  EXPECT_EQ(outline[3], Vector<2>(4.5, 3.5));
}

TEST(LargestPart, IsTheLargestRegionOfTheSamePixels) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    cv::RNG random(seed);
    cv::Mat mask(24, 31, CV_8UC1);
    for (int y = 0; y < mask.rows; ++y) {
      for (int x = 0; x < mask.cols; ++x) mask.at<std::uint8_t>(y, x) = random.uniform(0, 100) < 35 ? 255 : 0;
    }
    std::vector<PixelRun> runs;
    for (int y = 0; y < mask.rows; ++y) append_runs(mask.ptr<std::uint8_t>(y), y, mask.cols, runs);
    const auto regions = find_regions(mask, {.max_hole = 0});
    const auto largest =
        std::max_element(regions.begin(), regions.end(), [](const Region& a, const Region& b) { return a.area < b.area; });
    EXPECT_EQ(largest_part(runs), largest->runs) << "seed " << seed;
  }
  EXPECT_TRUE(largest_part({}).empty());
}

}  // namespace
}  // namespace marey::detect
