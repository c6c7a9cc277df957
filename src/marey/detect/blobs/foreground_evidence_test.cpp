#include "marey/detect/blobs/foreground_evidence.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"
#include "marey/filter/random_stream.h"

namespace marey::detect::blobs {
namespace {

/// A lawn with noise; a person on it wears white, grey or blue.
Frame lawn(std::uint64_t seed, const std::vector<cv::Rect>& people, double brightness = 1) {
  filter::RandomStream random(seed);
  cv::Mat bgr(160, 240, CV_8UC3, cv::Scalar(50 * brightness, 115 * brightness, 80 * brightness));
  const std::vector<cv::Scalar> shirts{{230, 230, 230}, {90, 90, 90}, {200, 60, 20}};
  for (std::size_t i = 0; i < people.size(); ++i) cv::rectangle(bgr, people[i], shirts[i % shirts.size()], cv::FILLED);
  for (cv::Vec3b& pixel : cv::Mat_<cv::Vec3b>(bgr)) {
    for (int c = 0; c < 3; ++c) pixel[c] = cv::saturate_cast<unsigned char>(pixel[c] + 2 * random.normal_pair().first);
  }
  Frame frame;
  frame.image = Image::from_bgr(bgr);
  return frame;
}

std::vector<Frame> beginning() {
  std::vector<Frame> frames;
  for (int i = 0; i < 20; ++i) {
    // Every person goes about, and is in each place in few frames.
    frames.push_back(
        lawn(static_cast<std::uint64_t>(i) + 1, {{10 + 10 * i, 20, 14, 40}, {200 - 9 * i, 70, 14, 40}, {20 + 8 * i, 110, 14, 40}}));
  }
  return frames;
}

/// Over the points of the grid within a rectangle, px.
double mean_within(const BlobEvidence& evidence, const cv::Rect& where) {
  double sum = 0;
  int count = 0;
  for (int row = 0; row < evidence.log_ratio.rows; ++row) {
    for (int column = 0; column < evidence.log_ratio.cols; ++column) {
      const Vector<2> at = evidence.origin + evidence.step * Vector<2>(column, row);
      if (!where.contains({static_cast<int>(at.x()), static_cast<int>(at.y())})) continue;
      sum += static_cast<double>(evidence.log_ratio.at<float>(row, column));
      ++count;
    }
  }
  return sum / count;
}

TEST(FilterBank, TellsLevelAndContrastOfASquare) {
  cv::Mat luma(60, 60, CV_8UC1, cv::Scalar(40));
  luma(cv::Rect(20, 20, 20, 20)) = 140;
  const cv::Mat responses = filter_responses(Image(luma), 5);
  ASSERT_EQ(responses.size(), cv::Size(12, 12));
  EXPECT_NEAR(responses.at<Response>(5, 5)[0], 140, 2);
  EXPECT_NEAR(responses.at<Response>(1, 1)[0], 40, 1);
  EXPECT_NEAR(responses.at<Response>(1, 1)[3], 0, 1) << "a Mexican hat sees no level";
  EXPECT_GT(responses.at<Response>(4, 4)[3], 5) << "but the corner of a square";
  EXPECT_EQ(responses.at<Response>(5, 5)[1], 128);
}

TEST(ForegroundEvidence, SaysWherePeopleAreAndWhereNobodyIs) {
  ForegroundEvidence detector({.step = 5});
  const std::vector<Frame> samples = beginning();
  detector.prime(samples);
  const cv::Rect white(60, 30, 14, 40), blue(150, 90, 14, 40);
  const auto found = detector.of(lawn(99, {white, {100, 60, 14, 40}, blue}));
  ASSERT_NE(found, nullptr);
  EXPECT_GT(mean_within(*found, white), 2);
  EXPECT_GT(mean_within(*found, blue), 2);
  EXPECT_LT(mean_within(*found, {180, 20, 40, 40}), -2);
}

TEST(ForegroundEvidence, AShadowIsNobody) {
  ForegroundEvidence detector({.step = 5});
  const std::vector<Frame> samples = beginning();
  detector.prime(samples);
  const auto found = detector.of(lawn(99, {}, 0.65));
  ASSERT_NE(found, nullptr);
  EXPECT_LT(mean_within(*found, {0, 0, 240, 160}), 0);
}

TEST(ForegroundEvidence, LearnsFromItsFirstFramesWhereNothingCanBeReadAhead) {
  ForegroundEvidence detector({.step = 5, .learning_frames = 20});
  for (const Frame& frame : beginning()) EXPECT_EQ(detector.of(frame), nullptr);
  const cv::Rect there(60, 30, 14, 40);
  const auto evidence = detector.of(lawn(99, {there}));
  ASSERT_NE(evidence, nullptr);
  EXPECT_GT(mean_within(*evidence, there), 2);
}

TEST(ForegroundEvidence, RefusesAGridOfNothing) {
  EXPECT_THROW(ForegroundEvidence({.step = 0}), Error);
}

}  // namespace
}  // namespace marey::detect::blobs
