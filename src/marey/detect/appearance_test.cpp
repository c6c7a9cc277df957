#include "marey/detect/appearance.h"

#include <array>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace marey::detect {
namespace {

const cv::Scalar grass(60, 140, 70), shirt(200, 60, 40), shorts(240, 240, 240), skin(120, 150, 200);

/// A person in a blue shirt on grass, with noise, and the silhouette as a background model would give it.
struct Scene {
  cv::Mat bgr, mask;
  Detection person;

  explicit Scene(int height, int left = 100, int top = 40) : bgr(400, 301, CV_8UC3, grass), mask(400, 301, CV_8UC1, cv::Scalar(0)) {
    const int width = height * 2 / 5;
    const auto part = [&](double from, double to, double fraction, const cv::Scalar& colour) {
      const int inset = static_cast<int>(width * (1 - fraction) / 2);
      const cv::Rect rect(left + inset, top + static_cast<int>(from * height), width - 2 * inset,
                          static_cast<int>(to * height) - static_cast<int>(from * height));
      bgr(rect).setTo(colour);
      mask(rect).setTo(255);
    };
    part(0, 0.15, 0.3, skin);
    part(0.15, 0.5, 0.7, shirt);
    part(0.5, 0.7, 0.6, shorts);
    part(0.7, 1, 0.5, skin);
    std::mt19937 random(5);
    std::normal_distribution<double> normal(0, 4);
    for (auto pixel = bgr.begin<cv::Vec3b>(); pixel != bgr.end<cv::Vec3b>(); ++pixel) {
      for (int c = 0; c < 3; ++c) (*pixel)[c] = cv::saturate_cast<uchar>((*pixel)[c] + normal(random));
    }
    person.box = {static_cast<double>(left), static_cast<double>(top), static_cast<double>(width), static_cast<double>(height)};
  }

  std::optional<Appearance> detected() const { return upper_body(Image::from_bgr(bgr), {.mask = mask}, {&person, 1}, 0); }
};

cv::Vec3f lab_of(const cv::Scalar& bgr) {
  cv::Mat one(1, 1, CV_32FC3, bgr / 255), lab;
  cv::cvtColor(one, lab, cv::COLOR_BGR2Lab);
  return lab.at<cv::Vec3f>(0, 0);
}

TEST(UpperBody, IsTheShirtsColourFarAndNear) {
  for (const int height : {30, 60, 101, 300}) {
    const auto detected = Scene(height).detected();
    ASSERT_TRUE(detected) << height;
    const cv::Vec3f truth = lab_of(shirt);
    EXPECT_NEAR(detected->lightness, truth[0], 5) << height;
    EXPECT_NEAR(detected->a, truth[1], 6) << height;
    EXPECT_NEAR(detected->b, truth[2], 6) << height;
    EXPECT_LT(detected->deviation, 6) << height;
    EXPECT_GE(detected->deviation, 2) << height;
  }
}

TEST(UpperBody, IgnoresBackgroundPixels) {
  Scene scene(100);
  scene.bgr(cv::Rect(100, 40, 20, 100)).setTo(cv::Scalar(0, 0, 255));
  scene.mask(cv::Rect(100, 40, 20, 100)).setTo(0);
  const auto detected = scene.detected();
  ASSERT_TRUE(detected);
  EXPECT_NEAR(detected->b, lab_of(shirt)[2], 6);
}

TEST(UpperBody, WithoutAMaskTheMiddleOfTheChestIsInspectedAndTrustedLess) {
  for (const int height : {60, 101, 300}) {
    const Scene scene(height);
    const auto detected = upper_body(Image::from_bgr(scene.bgr), {}, {&scene.person, 1}, 0);
    ASSERT_TRUE(detected) << height;
    EXPECT_NEAR(detected->lightness, lab_of(shirt)[0], 5) << height;
    EXPECT_NEAR(detected->b, lab_of(shirt)[2], 6) << height;
    EXPECT_GT(detected->deviation, scene.detected()->deviation) << height;
  }
}

TEST(UpperBody, NoColourIsToldWhereNoneIsSeen) {
  EXPECT_FALSE(Scene(8).detected()) << "too small";
  EXPECT_FALSE(Scene(200, 100, 0).detected()) << "the head may be outside the image";
  Scene no_person(100);
  no_person.mask.setTo(0);
  EXPECT_FALSE(no_person.detected());
  const Scene grey(100);
  cv::Mat luma;
  cv::cvtColor(grey.bgr, luma, cv::COLOR_BGR2GRAY);
  EXPECT_FALSE(upper_body(Image(luma), {.mask = grey.mask}, {&grey.person, 1}, 0));
  EXPECT_FALSE(lower_body(Image::from_bgr(grey.bgr), {}, {&grey.person, 1}, 0));
}

TEST(UpperBody, FindsPersonPartlyOccluded) {
  Scene scene(100);
  const cv::Rect before(124, 50, 40, 100);
  scene.bgr(before).setTo(cv::Scalar(0, 0, 255));
  scene.mask(before).setTo(255);
  std::array<Detection, 2> both = {scene.person, scene.person};
  both[0].group = both[1].group = 3;
  both[1].box = {124, 50, 40, 100};
  const Image image = Image::from_bgr(scene.bgr);
  const auto behind = upper_body(image, {.mask = scene.mask}, both, 0);
  const auto in_front = upper_body(image, {.mask = scene.mask}, both, 1);
  ASSERT_TRUE(behind && in_front);
  EXPECT_NEAR(behind->b, lab_of(shirt)[2], 6);
  EXPECT_GT(in_front->a, 60);
  EXPECT_GT(behind->deviation, 6);
}

TEST(UpperBody, BoxesBeyondThePictureAreNoTrouble) {
  const Scene scene(100);
  for (const Box& box : {Box{-50, 20, 60, 100}, Box{290, 390, 60, 100}, Box{5000, 5000, 10, 10}, Box{0, 20, 301, 380}}) {
    Detection person;
    person.box = box;
    const auto detected = upper_body(Image::from_bgr(scene.bgr), {.mask = scene.mask}, {&person, 1}, 0);
    EXPECT_TRUE(!detected || std::isfinite(detected->deviation));
  }
}

}  // namespace
}  // namespace marey::detect
