#include "marey/source/stabilise/stabiliser.h"

#include <cmath>
#include <optional>
#include <random>
#include <utility>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace marey::source::stabilise {
namespace {

constexpr int kMargin = 80;
const cv::Size kSize(480, 320);

/// A scene with corners, larger than the image by a margin on each side.
cv::Mat scene_of(unsigned seed) {
  std::mt19937 random(seed);
  cv::Mat scene(kSize.height + 2 * kMargin, kSize.width + 2 * kMargin, CV_8UC1, cv::Scalar(110));
  for (int i = 0; i < 400; ++i) {
    const cv::Rect spot(static_cast<int>(random() % 640), static_cast<int>(random() % 480), 6 + static_cast<int>(random() % 30),
                        6 + static_cast<int>(random() % 30));
    cv::rectangle(scene, spot, cv::Scalar(static_cast<double>(40 + random() % 170)), -1, cv::LINE_AA);
  }
  cv::GaussianBlur(scene, scene, {}, 0.8);
  return scene;
}

/// From pixels at rest to those of the camera that is aimed `by` px aside, of its focal length.
Matrix<3> rotated(const Vector<2>& by) {
  constexpr double kFocal = 1150;
  Matrix<3> lens;
  lens << kFocal, 0, (kSize.width - 1) / 2.0, 0, kFocal, (kSize.height - 1) / 2.0, 0, 0, 1;
  const Vector<3> turn(by.y() / kFocal, -by.x() / kFocal, 0.1 * by.x() / kFocal);
  const double angle = turn.norm();
  const Matrix<3> rotation = angle > 0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Matrix<3>::Identity().eval();
  return lens * rotation * lens.inverse();
}

/// The scene as a camera aimed `by` px aside sees it, with a bright box that walks and noise.
Image detected(const cv::Mat& scene, const Vector<2>& by, int walked, unsigned seed) {
  Matrix<3> of_scene = rotated(by).inverse();
  of_scene.topRows<2>() += kMargin * Vector<2>(1, 1) * of_scene.row(2);
  cv::Matx33d window;
  for (int i = 0; i < 9; ++i) window.val[i] = of_scene(i / 3, i % 3);
  cv::Mat image;
  cv::warpPerspective(scene, image, window, kSize, cv::INTER_CUBIC | cv::WARP_INVERSE_MAP);
  cv::rectangle(image, {40 + walked - static_cast<int>(by.x()), 120, 50, 110}, cv::Scalar(230), -1);
  cv::RNG random(seed + 1);
  cv::Mat noise(kSize, CV_16SC1), noisy;
  random.fill(noise, cv::RNG::NORMAL, 0, 2);
  cv::add(image, noise, noisy, cv::noArray(), CV_8U);
  return Image(noisy);
}

Vector<2> shake(int index, double size) {
  return size * Vector<2>(std::sin(0.9 * index) + 0.4 * std::sin(2.1 * index), std::cos(0.7 * index));
}

/// The same, the first image being the rest.
Vector<2> from_first(int index, double size) {
  return index == 0 ? Vector<2>(0, 0) : shake(index, size);
}

Frame frame_of(Image image, int index) {
  Frame frame;
  frame.index = index;
  frame.time = timestamp_from_seconds(index / 25.0);
  frame.image = std::move(image);
  return frame;
}

double observed_motion(const SceneMotion& motion, const PinholeView& view, const Vector<2>& truth) {
  double worst = 0;
  for (const Vector<2>& at : {Vector<2>(40, 40), Vector<2>(440, 40), Vector<2>(40, 280), Vector<2>(440, 280), Vector<2>(240, 160)})
    worst = std::max(worst, ((moved_from_rest(motion, view) * at.homogeneous()).hnormalized() -
                             (rotated(truth) * at.homogeneous()).hnormalized())
                                .norm());
  return worst;
}

TEST(ReferenceScene, TellsWhereThePictureLooksThoughSomebodyWalks) {
  for (const double size : {1.0, 5.0, 20.0}) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(testing::Message() << size << " px, seed " << seed);
      const cv::Mat scene = scene_of(seed);
      ReferenceScene standing(kSize, std::nullopt);
      double worst = 0;
      for (int i = 0; i < 60; ++i) {
        const auto motion = standing.find(detected(scene, from_first(i, size), 5 * i, 100 * seed + static_cast<unsigned>(i)));
        ASSERT_TRUE(motion) << i;
        if (i >= 20)
          worst = std::max(worst, observed_motion(*motion, standing.view(), from_first(i, size)));  // the lens is known by then
      }
      EXPECT_LT(worst, 0.35);
    }
  }
}

TEST(ReferenceScene, IsNotLostWhereSomebodyInPlainClothesHidesMostOfIt) {
  const cv::Mat scene = scene_of(6);
  std::vector<Image> samples;
  for (unsigned i = 0; i < 30; ++i) samples.push_back(detected(scene, {0, 0}, static_cast<int>(12 * i), i));
  ReferenceScene standing(kSize, std::nullopt);
  ASSERT_TRUE(standing.learn(samples));
  for (int i = 0; i < 140; ++i) {
    const int hidden = i < 100 ? std::min(390, 6 * i) : std::max(0, 390 - 15 * (i - 100));
    cv::Mat image = detected(scene, {0, 0}, 500, 100 + static_cast<unsigned>(i)).luma().clone();
    image.colRange(0, hidden).setTo(60);
    const auto motion = standing.find(Image(image));
    ASSERT_TRUE(motion) << i;
    EXPECT_LT(observed_motion(*motion, standing.view(), {0, 0}), 3) << i;  // at corners far from the strip that is seen
  }
}

TEST(ReferenceScene, RestsInTheMiddleOfWhatItLearned) {
  const cv::Mat scene = scene_of(4);
  std::vector<Image> samples;
  for (int i = 0; i < 30; ++i) samples.push_back(detected(scene, Vector<2>(9, 3) + shake(i, 4), 12 * i, static_cast<unsigned>(i)));
  ReferenceScene standing(kSize, std::nullopt);
  ASSERT_TRUE(standing.learn(samples));
  const auto motion = standing.find(detected(scene, Vector<2>(9, 3), 500, 99));
  ASSERT_TRUE(motion);
  EXPECT_LT(observed_motion(*motion, standing.view(), {0, 0}), 2);
}

/// A small, dull image of a road, shaken by `by`, on three lanes of which cars drive that cover a quarter of it.
Image traffic(const cv::Mat& road, const Vector<2>& by, int index) {
  cv::Mat scene = road.clone(), image;
  for (int lane = 0; lane < 3; ++lane) {
    for (int car = 0; car < 3; ++car) {
      const int x = (index * (5 + lane) + 220 * car + 37 * ((3 * lane + 5 * car) % 4)) % 660 - 60,
                length = 80 + 12 * ((lane + 2 * car) % 4);
      cv::rectangle(scene, {x, 100 + 58 * lane, length, 44}, cv::Scalar(60 + (75 * (lane + car)) % 190), cv::FILLED);
      cv::rectangle(scene, {x + 15 + 4 * car, 104 + 58 * lane, 46, 15}, cv::Scalar(car == 1 ? 120 : 20), cv::FILLED);
    }
  }
  const cv::Matx23d window(1, 0, 100 + by.x(), 0, 1, 80 + by.y());
  cv::warpAffine(scene, image, window, {320, 240}, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  cv::RNG random(static_cast<unsigned>(index) + 1);
  cv::Mat noise(image.size(), CV_16SC1), noisy;
  random.fill(noise, cv::RNG::NORMAL, 0, 2.5);
  cv::add(image, noise, noisy, cv::noArray(), CV_8U);
  return Image(noisy);
}

TEST(ReferenceScene, KeepsSmallPicturesThatCarsFill) {
  for (const auto& [size, seed] : {std::pair(4.0, 21U), std::pair(10.0, 22U)}) {
    SCOPED_TRACE(testing::Message() << size << " px, seed " << seed);
    cv::Mat road;
    scene_of(seed)(cv::Rect(0, 0, 520, 400)).convertTo(road, CV_8U, 0.4, 75);
    std::vector<Image> samples;
    for (int i = 0; i < 30; ++i) samples.push_back(traffic(road, shake(4 * i, size), 4 * i));
    ReferenceScene standing({320, 240}, std::nullopt);
    ASSERT_TRUE(standing.learn(samples));
    std::optional<Vector<2>> rest;
    for (int i = 0; i < 60; ++i) {
      const auto motion = standing.find(traffic(road, shake(i, size), i));
      ASSERT_TRUE(motion) << i;
      const Vector<2> middle(159.5, 119.5),
          moved = (moved_from_rest(*motion, standing.view()) * middle.homogeneous()).hnormalized();
      const Vector<2> by = moved - middle + shake(i, size);
      if (!rest) rest = by;
      EXPECT_LT((by - *rest).norm(), 1) << i;
    }
  }
}

TEST(ReferenceScene, LearnsNothingWhereNothingStands) {
  std::vector<Image> samples;
  std::mt19937 random(5);
  for (int i = 0; i < 10; ++i) {
    cv::Mat image(kSize, CV_8UC1);
    for (int k = 0; k < static_cast<int>(image.total()); ++k) image.data[k] = static_cast<std::uint8_t>(118 + random() % 5);
    samples.emplace_back(image);
  }
  ReferenceScene standing(kSize, std::nullopt);
  EXPECT_FALSE(standing.learn(samples));
  EXPECT_FALSE(standing.learn({}));
  std::vector<Image> black(10, Image(cv::Mat(kSize, CV_8UC1, cv::Scalar(0))));
  EXPECT_FALSE(standing.learn(black));
  EXPECT_FALSE(standing.find(black.front()));
}

TEST(ReferenceScene, FollowsTheSceneThroughClouds) {
  const cv::Mat scene = scene_of(6);
  ReferenceScene standing(kSize, std::nullopt);
  for (int i = 0; i < 60; ++i) {
    cv::Mat dark;
    detected(scene, from_first(i, 3), 5 * i, static_cast<unsigned>(i)).luma().convertTo(dark, CV_8U, i > 20 ? 0.55 : 1.0);
    const auto motion = standing.find(Image(dark));
    ASSERT_TRUE(motion) << i;
    EXPECT_LT(observed_motion(*motion, standing.view(), from_first(i, 3)), 0.5) << i;
  }
}

TEST(Stabiliser, GivesThePictureOfTheRest) {
  const cv::Mat scene = scene_of(7);
  const auto log = std::make_shared<StabilisationLog>();
  Stabiliser steadier(ReferenceScene(kSize, std::nullopt), log);
  const Image rest = detected(scene, Vector<2>(0, 0), 2000, 1);
  steadier.stabilised(frame_of(rest, 0));
  for (int i = 1; i < 30; ++i) {
    const Frame frame = steadier.stabilised(frame_of(detected(scene, shake(i, 8), 2000, static_cast<unsigned>(i)), i));
    cv::Mat off;
    cv::absdiff(frame.image.luma(), rest.luma(), off);
    EXPECT_LT(cv::mean(off(cv::Rect(30, 30, 420, 260)))[0], 4) << i;
    EXPECT_LT(cv::mean(off)[0], 5) << i;  // what lay outside shows the earlier image there
  }
  const StabilisationLog::Report report = log->report();
  EXPECT_EQ(report.images, 30);
  EXPECT_EQ(report.lost, 0);
  EXPECT_NEAR(report.rms_px, 8, 2);
  EXPECT_FALSE(report.bump);
}

TEST(Stabiliser, SaysWhatItCouldNotSteadyAndComesBack) {
  const cv::Mat scene = scene_of(8), other = scene_of(9);
  const auto log = std::make_shared<StabilisationLog>();
  Stabiliser steadier(ReferenceScene(kSize, std::nullopt), log);
  const auto lost_at = [](int i) { return i >= 20 && i < 60; };
  int wrong = 0;
  for (int i = 0; i < 90; ++i) {
    Image image = detected(lost_at(i) ? other : scene, from_first(i, 3), 4 * i, static_cast<unsigned>(i));
    if (i == 70) image = Image(cv::Mat(200, 300, CV_8UC1, cv::Scalar(50)));
    steadier.stabilised(frame_of(image, i));
    wrong += log->was_lost(i) != (lost_at(i) || i == 70) ? 1 : 0;
  }
  EXPECT_LE(wrong, 5);  // a camera that was lost for long is searched for every fifth image
  EXPECT_GE(log->report().lost, 40);
  EXPECT_FALSE(log->report().lost_since_s);
  EXPECT_EQ(warned(log->report()).size(), 1U);
}

TEST(Stabiliser, SaysThatTheCameraWasTurnedForGood) {
  const cv::Mat scene = scene_of(10);
  const auto log = std::make_shared<StabilisationLog>();
  Stabiliser steadier(ReferenceScene(kSize, std::nullopt), log);
  for (int i = 0; i < 250; ++i) {
    const Vector<2> by = from_first(i, 2) + (i >= 120 ? Vector<2>(30, -12) : Vector<2>(0, 0));
    steadier.stabilised(frame_of(detected(scene, by, i, static_cast<unsigned>(i)), i));
  }
  const StabilisationLog::Report report = log->report();
  ASSERT_TRUE(report.bump);
  EXPECT_NEAR(report.bump->by_px, std::hypot(30, 12), 2);
  EXPECT_NEAR(report.bump->time, 120 / 25.0, 1.1);
}

TEST(MotionAmong, IsThatOfTheCameraNotOfPeople) {
  const cv::Mat scene = scene_of(11);
  std::vector<Frame> still, shaken;
  for (int i = 0; i < 30; ++i) {
    still.push_back(frame_of(detected(scene, {0, 0}, 12 * i, static_cast<unsigned>(i)), 10 * i));
    shaken.push_back(frame_of(detected(scene, shake(i, 4), 12 * i, static_cast<unsigned>(i)), 10 * i));
  }
  ASSERT_TRUE(motion_among(still));
  EXPECT_LT(*motion_among(still), 0.2);
  ASSERT_TRUE(motion_among(shaken));
  EXPECT_NEAR(*motion_among(shaken), 4, 1.2);
}

}  // namespace
}  // namespace marey::source::stabilise
