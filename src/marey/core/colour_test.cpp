#include "marey/core/colour.h"

#include <random>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace marey {
namespace {

TEST(Lab, AgreesWithOpenCv) {
  std::mt19937 random(3);
  cv::Mat bgr(1, 500, CV_32FC3);
  for (int i = 0; i < bgr.cols; ++i) {
    for (int c = 0; c < 3; ++c) bgr.at<cv::Vec3f>(0, i)[c] = static_cast<float>(random() % 256) / 255.0F;
  }
  cv::Mat lab;
  cv::cvtColor(bgr, lab, cv::COLOR_BGR2Lab);
  for (int i = 0; i < bgr.cols; ++i) {
    const cv::Vec3f detected = bgr.at<cv::Vec3f>(0, i) * 255;
    const std::array<float, 3> ours = lab_from_srgb(detected[2], detected[1], detected[0]);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(ours[c], lab.at<cv::Vec3f>(0, i)[c], 0.5) << i;
    const std::array<float, 3> back = srgb_from_lab(ours[0], ours[1], ours[2]);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(back[c], detected[2 - c], 0.2) << i;
  }
}

TEST(Lab, ClampsOutOfGamutColours) {
  EXPECT_EQ(lab_from_srgb(300, 255, 255), lab_from_srgb(255, 255, 255));
  const std::array<float, 3> green = srgb_from_lab(60, -120, 100);
  for (const float part : green) {
    EXPECT_GE(part, 0);
    EXPECT_LE(part, 255);
  }
}

TEST(Perceived, IsUndoneByColourAt) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> part(-90, 90);
  for (int i = 0; i < 200; ++i) {
    const Appearance colour{.lightness = part(random) / 2 + 50, .a = part(random), .b = part(random), .deviation = 7};
    const Appearance back = colour_at(perceived(colour), 7);
    EXPECT_NEAR(back.lightness, colour.lightness, 1e-3);
    EXPECT_NEAR(back.a, colour.a, 1e-3);
    EXPECT_NEAR(back.b, colour.b, 1e-3);
    EXPECT_EQ(back.deviation, 7);
  }
}

TEST(Perceived, ShadeCountsLessThanHue) {
  const Appearance red{.lightness = 50, .a = 40, .b = 0}, shaded{.lightness = 30, .a = 40, .b = 0},
      green{.lightness = 50, .a = 20, .b = 0};
  EXPECT_NEAR((perceived(red) - perceived(shaded)).norm(), 12, 1e-6);
  EXPECT_GT((perceived(red) - perceived({.lightness = 50, .a = -40, .b = 0})).norm(), (perceived(red) - perceived(green)).norm());
}

}  // namespace
}  // namespace marey
