#pragma once

// For tests: people-shaped silhouettes with known boxes.

#include <random>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "marey/core/geometry.h"
#include "marey/detect/silhouette.h"

namespace marey::bodies {

/// Uniform in [low, high), the same everywhere.
inline double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
}

/// The box that a person 0.36 times as wide as tall fills, with feet at (x, y).
inline Box person(double x, double y, double height) {
  const double width = 0.36 * height;
  return {std::round(x - width / 2), std::round(y - height), std::round(width), std::round(height)};
}

/// Draws head, trunk and two legs that fill `box`, with `stride` 0 (legs together) to 1 (apart).
inline void draw(cv::Mat& mask, const Box& box, double stride = 0.5) {
  const auto at = [&](double x, double y) {
    return cv::Point(static_cast<int>(std::lround(box.left + x * (box.width - 1))),
                     static_cast<int>(std::lround(box.top + y * (box.height - 1))));
  };
  const auto size = [&](double w, double h) {
    return cv::Size(static_cast<int>(std::lround(w * box.width / 2)), static_cast<int>(std::lround(h * box.height / 2)));
  };
  cv::ellipse(mask, at(0.5, 0.1), size(0.42, 0.2), 0, 0, 360, 255, cv::FILLED);
  cv::rectangle(mask, at(0.08, 0.17), at(0.92, 0.38), 255, cv::FILLED);
  cv::rectangle(mask, at(0.2, 0.38), at(0.8, 0.55), 255, cv::FILLED);
  const double apart = 0.25 * stride;
  for (const double side : {-1.0, 1.0}) {
    const std::vector<cv::Point> leg = {at(0.5 + side * 0.02 - 0.16, 0.5), at(0.5 + side * 0.02 + 0.16, 0.5),
                                        at(0.5 + side * apart + 0.16, 1.0), at(0.5 + side * apart - 0.16, 1.0)};
    cv::fillConvexPoly(mask, leg, 255);
  }
}

/// All pixels of `mask`, in order.
inline std::vector<detect::PixelRun> runs(const cv::Mat& mask) {
  std::vector<detect::PixelRun> result;
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      if (mask.at<std::uint8_t>(y, x) == 0) continue;
      const int begin = x;
      while (x < mask.cols && mask.at<std::uint8_t>(y, x) != 0) ++x;
      result.push_back({y, begin, x});
    }
  }
  return result;
}

}  // namespace marey::bodies
