#include "marey/detect/background/background_patches.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace marey::detect::background {
namespace {

constexpr int kBlack = 16;

/// Slabs of random levels.
cv::Mat slabs(std::uint32_t seed) {
  std::mt19937 random(seed);
  cv::Mat coarse(48, 64, CV_8UC1), fine;
  for (int i = 0; i < static_cast<int>(coarse.total()); ++i) coarse.data[i] = static_cast<std::uint8_t>(80 + random() % 50);
  cv::resize(coarse, fine, {320, 240}, 0, 0, cv::INTER_NEAREST);
  return fine;
}

/// `image` with `gain` times the light over black within `where`.
cv::Mat lit(cv::Mat image, const cv::Rect& where, double gain) {
  image = image.clone();
  cv::Mat part = image(where);
  part.convertTo(part, CV_8U, gain, kBlack * (1 - gain));
  return image;
}

TEST(LightPatches, FindAShadowAndItsEnd) {
  const cv::Mat ground = slabs(1);
  ScenePlane scene(8, 56);
  scene.begin(ground);
  LightPatches patches;
  EXPECT_FALSE(patches.measure(ground, scene, kBlack));
  const cv::Rect shade(128, 64, 112, 96);
  for (const double gain : {0.65, 1.4}) {
    const cv::Mat now = lit(ground, shade, gain);
    const auto gains = patches.measure(now, scene, kBlack);
    ASSERT_TRUE(gains) << gain;
    const auto at = [&](int x, int y) { return gains->at<float>(y * gains->rows / 240, x * gains->cols / 320); };
    EXPECT_NEAR(at(180, 110), gain, 0.02);
    EXPECT_EQ(at(40, 40), 1);
    EXPECT_EQ(at(290, 200), 1);
    ScenePlane relit(8, 56);
    relit.begin(ground);
    relit.relight(*gains, kBlack);
    const cv::Rect inner(152, 88, 64, 48);
    EXPECT_LT(cv::norm(relit.image()(inner), now(inner), cv::NORM_INF), 3) << gain;
    EXPECT_EQ(cv::countNonZero(relit.image()({0, 0, 90, 240}) != ground({0, 0, 90, 240})), 0) << gain;
  }
}

TEST(LightPatches, AThingBeforeTheSceneIsNoLight) {
  const cv::Mat ground = slabs(2), other = slabs(3);
  ScenePlane scene(8, 56);
  scene.begin(ground);
  LightPatches patches;
  for (const double level : {30.0, 60.0, 160.0}) {
    cv::Mat coat = ground.clone();
    coat({100, 60, 64, 120}).setTo(level);
    EXPECT_FALSE(patches.measure(coat, scene, kBlack)) << "a plain coat of level " << level;
  }
  cv::Mat pattern = ground.clone();
  other({100, 60, 64, 120}).copyTo(pattern({100, 60, 64, 120}));
  EXPECT_FALSE(patches.measure(pattern, scene, kBlack)) << "a patterned coat";
}

TEST(LightPatches, ASlopeThatACoatSharesWithTheWallIsNoLight) {
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0, 1.5);
  cv::Mat wall(240, 320, CV_8UC1), coat(240, 320, CV_8UC1);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      const double slope = 25 * std::sin(0.07 * x) * std::cos(0.05 * y);
      wall.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(140 + slope + noise(random));
      coat.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(90 + 0.6 * slope + noise(random));
    }
  }
  ScenePlane scene(8, 56);
  scene.begin(wall);
  cv::Mat now = wall.clone();
  const cv::Rect where(80, 40, 160, 200);
  coat(where).copyTo(now(where));
  EXPECT_FALSE(LightPatches().measure(now, scene, kBlack));
}

TEST(LightPatches, SingleCellIsNoLightWithoutNeighbour) {
  const cv::Mat ground = slabs(5);
  ScenePlane scene(8, 56);
  scene.begin(ground);
  const cv::Rect one(160, 96, 18, 18), many(64, 64, 98, 98);
  EXPECT_FALSE(LightPatches().measure(lit(ground, one, 0.6), scene, kBlack));
  LightPatches patches;
  ASSERT_TRUE(patches.measure(lit(ground, many, 0.6), scene, kBlack));
  EXPECT_TRUE(patches.measure(lit(ground, one, 0.6), scene, kBlack));
  EXPECT_FALSE(patches.measure(lit(ground, one + cv::Point(96, 64), 0.6), scene, kBlack));
  for (int inspect = 0; inspect < 40; ++inspect) patches.measure(ground, scene, kBlack);
  EXPECT_FALSE(patches.measure(lit(ground, one, 0.6), scene, kBlack)) << "long ago";
}

TEST(LightPatches, TakePicturesOfAnySize) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(2, 40), cv::Size(40, 2), cv::Size(33, 17)}) {
    ScenePlane scene(8, 56);
    scene.begin(cv::Mat(size, CV_8UC1, cv::Scalar(100)));
    LightPatches patches;
    EXPECT_FALSE(patches.measure(cv::Mat(size, CV_8UC1, cv::Scalar(70)), scene, kBlack)) << size;
  }
}

}  // namespace
}  // namespace marey::detect::background
