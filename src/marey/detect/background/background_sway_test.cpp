#include "marey/detect/background/background_sway.h"

#include <random>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace marey::detect::background {
namespace {

/// Blocks of random levels, with noise of its own; what is beyond the image is there too.
cv::Mat blocks(std::uint32_t seed) {
  std::mt19937 random(seed);
  cv::Mat coarse(20, 24, CV_8UC1), fine;
  for (int i = 0; i < static_cast<int>(coarse.total()); ++i) coarse.data[i] = static_cast<std::uint8_t>(40 + random() % 180);
  cv::resize(coarse, fine, {480, 400}, 0, 0, cv::INTER_NEAREST);
  cv::GaussianBlur(fine, fine, {}, 0.7);
  return fine;
}

cv::Mat detected(const cv::Mat& world, cv::Point shift) {
  return world({80 - shift.x, 80 - shift.y, 320, 240}).clone();
}

TEST(SwayMeter, TellsEveryShiftWithinItsReach) {
  const cv::Mat world = blocks(3);
  ScenePlane scene(8, 56);
  scene.begin(detected(world, {}));
  for (const cv::Point shift : {cv::Point(0, 0), cv::Point(1, 0), cv::Point(-2, 3), cv::Point(7, -5), cv::Point(-15, 12)}) {
    SwayMeter meter;
    EXPECT_EQ(meter.measure(detected(world, shift), scene), shift) << shift;
  }
}

TEST(SwayMeter, IsNotMovedByAThingBeforeTheSceneNorByItsLight) {
  const cv::Mat world = blocks(4);
  ScenePlane scene(8, 56);
  scene.begin(detected(world, {}));
  SwayMeter meter;
  for (int i = 0; i < 40; ++i) {
    cv::Mat image = detected(world, {});
    image.convertTo(image, CV_8U, i % 2 == 0 ? 1 : 0.85, 0);
    cv::rectangle(image, {40 + 4 * i, 60, 70, 140}, cv::Scalar(30 + 5 * i), cv::FILLED);
    ASSERT_EQ(meter.measure(image, scene), cv::Point()) << "frame " << i;
  }
}

TEST(SwayMeter, SaysNothingOfAPictureWithoutEdges) {
  ScenePlane scene(8, 56);
  scene.begin(cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)));
  SwayMeter meter;
  EXPECT_EQ(meter.measure(cv::Mat(240, 320, CV_8UC1, cv::Scalar(140)), scene), cv::Point());
  ScenePlane tiny(8, 56);
  tiny.begin(cv::Mat(3, 2, CV_8UC1, cv::Scalar(90)));
  SwayMeter other;
  EXPECT_EQ(other.measure(cv::Mat(3, 2, CV_8UC1, cv::Scalar(0)), tiny), cv::Point());
}

TEST(SwayMeter, APictureBroughtBackIsTheSceneAndItsMaskLiesWhereThePictureHasIt) {
  const cv::Mat world = blocks(5);
  ScenePlane luma(8, 56), cb(6, 56), cr(6, 56);
  luma.begin(detected(world, {}));
  const cv::Point shift(5, -4);
  const FramePlanes back = brought_back({detected(world, shift), {}, {}}, shift, luma, cb, cr);
  EXPECT_EQ(cv::countNonZero(back.luma != luma.image()), 0) << "what lies outside is the scene itself";
  cv::Mat mask = cv::Mat::zeros(240, 320, CV_8UC1), carried;
  mask.at<std::uint8_t>(100, 50) = 255;
  mask.at<std::uint8_t>(1, 319) = 255;  // outside the image
  carry_over(mask, shift, carried);
  EXPECT_EQ(cv::countNonZero(carried), 1);
  EXPECT_EQ(carried.at<std::uint8_t>(96, 55), 255);
}

}  // namespace
}  // namespace marey::detect::background
