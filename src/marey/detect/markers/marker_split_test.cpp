#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "marey/detect/markers/marker_detector.h"

namespace marey::detect::markers {
namespace {

/// A disc of radius 5 at (x, 30) on a dark ground, in front of which, or behind, there is a bar of level 108 from column 40 on.
Frame disc_at_a_bar(double x, bool before) {
  cv::Mat image(64, 80, CV_8U);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 1.5);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const double disc = 0.5 * std::erfc((std::hypot(u - x, v - 30.0) - 5) / (std::sqrt(2.0) * 0.55));
      const double bar = u >= 40 ? 108 : 12, under = before ? bar : 12;
      const double level = before || u < 40 ? under + (202 - under) * disc : bar;
      image.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(level + noise(random));
    }
  }
  Frame frame;
  frame.image = Image(image);
  return frame;
}

TEST(MarkerSplit, KeepsSingleMarkerAtBarEdge) {
  for (const bool before : {false, true}) {
    for (double x = 20; x < 39; x += 0.7) {
      MarkerDetector detector;
      detector.detect(disc_at_a_bar(20, before), {});  // what a marker is like
      const auto found = detector.detect(disc_at_a_bar(x, before), {}).detections;
      EXPECT_LE(found.size(), 1U) << x << (before ? " before" : " behind");
      EXPECT_TRUE(found.size() == 1 || x >= 35) << x;
    }
  }
}

}  // namespace
}  // namespace marey::detect::markers
