#include "marey/source/stabilise/scene_appearance.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace marey::source::stabilise {
namespace {

const cv::Size kSmallSize(320, 240);
const PinholeView kSmallView{480, {159.5, 119.5}};

/// A dull road scene: a few faint lines and patches, larger than the image.
cv::Mat dull_scene(unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](int maximum) { return static_cast<int>(random() % static_cast<unsigned>(maximum)); };
  cv::Mat scene(440, 520, CV_8UC1, cv::Scalar(120));
  for (int i = 0; i < 60; ++i)
    cv::line(scene, {below(520), below(440)}, {below(520), below(440)}, cv::Scalar(75 + below(90)), 1 + below(4), cv::LINE_AA);
  for (int i = 0; i < 60; ++i)
    cv::rectangle(scene, {below(500), below(420), 8 + below(40), 8 + below(40)}, cv::Scalar(75 + below(90)), cv::FILLED);
  cv::GaussianBlur(scene, scene, {}, 1.2);
  return scene;
}

/// The part that is seen `by` px aside, with white and black cars over a quarter of it, which are at `drive`, and noise.
cv::Mat with_cars(const cv::Mat& scene, cv::Point by, int drive, unsigned seed) {
  cv::Mat image = scene(cv::Rect(cv::Point(100, 100) + by, kSmallSize)).clone();
  for (int lane = 0; lane < 3; ++lane) {
    for (int car = 0; car < 2; ++car) {
      const int x = (drive * (3 + 2 * lane) + 240 * car + 60 * lane) % 510 - 120 - by.x, y = 60 + 60 * lane - by.y;
      const int length = 70 + 15 * lane + 10 * car;
      cv::rectangle(image, {x, y, length, 45}, cv::Scalar(car == 0 ? 240 : 15), cv::FILLED);
      cv::rectangle(image, {x + 15 + 5 * lane, y + 5, 40, 15}, cv::Scalar(car == 0 ? 30 : 120), cv::FILLED);
    }
  }
  cv::RNG noise_of(seed + 1);
  cv::Mat noise(kSmallSize, CV_16SC1), noisy;
  noise_of.fill(noise, cv::RNG::NORMAL, 0, 2);
  cv::add(image, noise, noisy, cv::noArray(), CV_8U);
  return noisy;
}

Vector<2> middle_of(const SceneMotion& motion) {
  const Vector<3> at = moved_from_rest(motion, kSmallView) * Vector<3>(kSmallView.principal.x(), kSmallView.principal.y(), 1);
  return Vector<2>(at.x() / at.z(), at.y() / at.z()) - kSmallView.principal;
}

TEST(SceneAppearance, FindsADullSceneBehindManyCars) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const cv::Mat scene = dull_scene(seed);
    const SceneAppearance rest(scene(cv::Rect(cv::Point(100, 100), kSmallSize)).clone());
    ASSERT_TRUE(rest.can_be_found());
    for (const cv::Point by : {cv::Point(0, 0), cv::Point(5, -3), cv::Point(-23, 14), cv::Point(25, -18)}) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", " << by);
      const auto found = rest.find(SceneAppearance(with_cars(scene, by, 13, seed + 50)), kSmallView, 96);
      ASSERT_TRUE(found);
      EXPECT_LT((middle_of(found->motion) + Vector<2>(by.x, by.y)).norm(), 0.5);
    }
  }
}

TEST(SceneAppearance, DoesNotFindAnotherScene) {
  int wrong = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const SceneAppearance rest(with_cars(dull_scene(seed), {0, 0}, 0, seed));
    wrong += rest.find(SceneAppearance(with_cars(dull_scene(seed + 100), {0, 0}, 13, seed)), kSmallView, 96) ? 1 : 0;
  }
  EXPECT_LE(wrong, 1);
}

TEST(SceneAppearance, FindsNothingInNothing) {
  const SceneAppearance black(cv::Mat(kSmallSize, CV_8UC1, cv::Scalar(0)));
  EXPECT_FALSE(black.can_be_found());
  EXPECT_FALSE(black.find(black, kSmallView, 96));
  EXPECT_FALSE(SceneAppearance().can_be_found());
  EXPECT_FALSE(SceneAppearance().find(black, kSmallView, 96));
  EXPECT_FALSE(SceneAppearance(cv::Mat(3, 5, CV_8UC1, cv::Scalar(9))).can_be_found());
}

}  // namespace
}  // namespace marey::source::stabilise
