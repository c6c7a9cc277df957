#include "marey/detect/background/background_fringe.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "marey/detect/background/background_plane.h"
#include "marey/detect/runs.h"

namespace marey::detect::background {
namespace {

/// Share of a pixel that a disc covers, by counting points.
double covered(int x, int y, double centre, double radius) {
  int inside = 0;
  for (int i = 0; i < 64; ++i) {
    const double dx = x - centre + (i % 8 + 0.5) / 8 - 0.5, dy = y - centre + (i / 8 + 0.5) / 8 - 0.5;
    inside += dx * dx + dy * dy < radius * radius ? 1 : 0;
  }
  return inside / 64.0;
}

TEST(Fringe, TrimmedDiscKeepsItsSize) {
  for (const double radius : {4.0, 7.3, 12.6}) {
    for (const int level : {220, 150, 20}) {
      cv::Mat ground(41, 41, CV_8UC1, cv::Scalar(100)), image = ground.clone();
      cv::Mat mask = cv::Mat::zeros(41, 41, CV_8UC1), left = mask.clone();
      for (int y = 0; y < 41; ++y) {
        for (int x = 0; x < 41; ++x) {
          const double fraction = covered(x, y, 20.3, radius);
          image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(100 + fraction * (level - 100));
          if (std::abs(image.at<std::uint8_t>(y, x) - 100) > 3) mask.at<std::uint8_t>(y, x) = 255;
        }
      }
      ScenePlane luma(8, 56), none(6, 56);
      luma.begin(ground);
      std::vector<PixelRun> runs;
      for (int y = 0; y < 41; ++y) append_runs(mask.ptr<std::uint8_t>(y), y, 41, runs);
      trim_fringe(mask, runs, {image, {}, {}}, {luma, none, none, 0}, left);
      const double area = 3.14159265 * radius * radius;
      EXPECT_GT(cv::countNonZero(mask), 1.06 * area) << "too wide before";
      EXPECT_NEAR(cv::countNonZero(left), area, 0.04 * area + 2) << radius << " " << level;
    }
  }
}

}  // namespace
}  // namespace marey::detect::background
