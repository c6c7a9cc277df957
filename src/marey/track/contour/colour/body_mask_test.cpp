#include "marey/track/contour/colour/body_mask.h"

#include <gtest/gtest.h>

namespace marey::track::contour::colour {
namespace {

TEST(BodyMask, LiesOnThePatchWhereItLiesInTheImage) {
  ColourPatch patch;
  patch.corner = {100, 40};
  patch.colour = cv::Mat(30, 40, CV_32FC3, cv::Scalar(90, 128, 128));
  // Cells of a quarter of a pixel, from (105, 45) on; its right half is the person.
  BodyMask mask{.chance = cv::Mat(64, 64, CV_32FC1, cv::Scalar(0.1)), .corner = {105, 45}, .scale = 0.25};
  mask.chance.colRange(32, 64).setTo(0.9);
  const cv::Mat chances = chances_in(mask, patch);
  EXPECT_NEAR(chances.at<float>(10, 8), 0.1, 1e-4);
  EXPECT_NEAR(chances.at<float>(10, 17), 0.9, 1e-4);
  EXPECT_NEAR(chances.at<float>(10, 13), 0.6, 0.25) << "the border between both";
  EXPECT_EQ(chances.at<float>(2, 10), 0.5F) << "above the mask";
  EXPECT_EQ(chances.at<float>(10, 35), 0.5F) << "right of it";
}

TEST(BodyMask, SaysNothingWhereItIsEmpty) {
  ColourPatch patch;
  patch.colour = cv::Mat(5, 6, CV_32FC3, cv::Scalar(90, 128, 128));
  const cv::Mat chances = chances_in({}, patch);
  EXPECT_EQ(cv::countNonZero(chances != 0.5F), 0);
  EXPECT_EQ(evidence_of(0.5F), 0);
  EXPECT_GT(evidence_of(0.9F), 0);
  EXPECT_EQ(evidence_of(1), evidence_of(0.99F)) << "never wholly sure";
  EXPECT_NEAR(evidence_of(0.2F), -evidence_of(0.8F), 1e-5);
}

}  // namespace
}  // namespace marey::track::contour::colour
