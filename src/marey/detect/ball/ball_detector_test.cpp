#include "marey/detect/ball/ball_detector.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace marey::detect::ball {
namespace {

/// Grass with a white line, and discs of white.
struct Disc {
  Vector<2> centre;
  double radius;
};

Frame grass(const std::vector<Disc>& discs, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 1.5);
  cv::Mat luma(200, 300, CV_8UC1);
  constexpr int kFine = 5;
  for (int y = 0; y < luma.rows; ++y) {
    for (int x = 0; x < luma.cols; ++x) {
      double level = y >= 100 && y < 103 ? 200 : 90;
      for (const Disc& disc : discs) {
        int inside = 0;
        for (int i = 0; i < kFine * kFine; ++i) {
          const Vector<2> at(x + (i % kFine + 0.5) / kFine - 0.5, y + (i / kFine + 0.5) / kFine - 0.5);
          inside += (at - disc.centre).norm() < disc.radius ? 1 : 0;
        }
        level += (190 - level) * inside / (kFine * kFine);
      }
      luma.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(std::clamp(level + noise(random), 0.0, 255.0));
    }
  }
  Frame frame;
  frame.image = Image(luma);
  return frame;
}

BallDetector primed() {
  BallDetector detector([](const Vector<2>&) { return 2.5; });
  const std::vector<Frame> empty{grass({}, 1), grass({}, 2), grass({}, 3)};
  detector.prime(empty);
  return detector;
}

TEST(BallDetector, FindsABallToAFractionOfAPixel) {
  BallDetector detector = primed();
  const Vector<2> at(151.3, 60.7);
  const auto found = detector.detect(grass({{at, 2.6}}, 4));
  ASSERT_FALSE(found.empty());
  EXPECT_LT((found[0].centre - at).norm(), 0.3);
  EXPECT_NEAR(found[0].radius, 2.6, 0.5);
  EXPECT_GT(found[0].score, 0.5);
}

TEST(BallDetector, ShirtsAndSpecksAreNoBalls) {
  BallDetector detector = primed();
  const auto found = detector.detect(grass({{{80, 60}, 14}, {{200, 60}, 0.7}}, 5));
  EXPECT_TRUE(found.empty());
}

TEST(BallDetector, ABallIsAloneAndASockIsNot) {
  const Vector<2> at(151, 60);
  EXPECT_LT(primed().detect(grass({{at, 2.6}}, 6)).at(0).local_clutter, 0.01);
  Frame beside_a_leg = grass({{at, 2.6}}, 6);
  cv::Mat luma = beside_a_leg.image.luma().clone();
  cv::rectangle(luma, cv::Rect(144, 36, 14, 20), 30, cv::FILLED);
  beside_a_leg.image = Image(luma);
  EXPECT_GT(primed().detect(beside_a_leg).at(0).local_clutter, 0.1);
}

}  // namespace
}  // namespace marey::detect::ball
