#include "marey/draw/jpeg.h"

#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace marey::draw {
namespace {

cv::Mat read_back(const std::string& jpeg) {
  return cv::imdecode(std::vector<unsigned char>(jpeg.begin(), jpeg.end()), cv::IMREAD_COLOR);
}

double mean_difference(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L1) / (static_cast<double>(a.total()) * 3);
}

TEST(Jpeg, LooksAsThePictureDoes) {
  cv::Mat bgr(121, 163, CV_8UC3);
  for (int y = 0; y < bgr.rows; ++y) {
    for (int x = 0; x < bgr.cols; ++x)
      bgr.at<cv::Vec3b>(y, x) = cv::Vec3b(static_cast<unsigned char>(x), static_cast<unsigned char>(2 * y), 90);
  }
  const Image colour = Image::from_bgr(bgr);
  JpegEncoder encoder;
  const cv::Mat whole = read_back(encoder.encode(colour, 4096));
  ASSERT_EQ(whole.size(), bgr.size());
  EXPECT_LT(mean_difference(whole, colour.bgr()), 4);
  const cv::Mat small = read_back(encoder.encode(colour, 80));
  ASSERT_EQ(small.cols, 80);
  cv::Mat expected;
  cv::resize(colour.bgr(), expected, small.size(), 0, 0, cv::INTER_AREA);
  EXPECT_LT(mean_difference(small, expected), 5);
}

TEST(Jpeg, VideosRangeIsStretched) {
  const cv::Mat luma(32, 32, CV_8UC1, cv::Scalar(235)), chroma(16, 16, CV_8UC1, cv::Scalar(128));
  const cv::Mat read = read_back(JpegEncoder().encode(Image(luma, chroma, chroma, Image::Range::limited), 64));
  EXPECT_NEAR(read.at<cv::Vec3b>(9, 9)[1], 255, 2);
}

TEST(Jpeg, GreyOfSixteenBitsAndPartsOfPictures) {
  const cv::Mat deep(40, 60, CV_16UC1, cv::Scalar(257 * 200));
  EXPECT_NEAR(read_back(JpegEncoder().encode(Image(deep), 64)).at<cv::Vec3b>(5, 5)[0], 200, 2);
  cv::Mat wide(40, 60, CV_8UC1, cv::Scalar(0));
  wide(cv::Rect(10, 10, 20, 20)).setTo(180);
  const cv::Mat part = read_back(JpegEncoder().encode(Image(wide(cv::Rect(10, 10, 20, 20))), 64));
  ASSERT_EQ(part.size(), cv::Size(20, 20));
  EXPECT_NEAR(part.at<cv::Vec3b>(19, 19)[0], 180, 2);
}

TEST(Jpeg, QualityIsWhatIsLeftOfIt) {
  cv::Mat noise(64, 64, CV_8UC1);
  cv::randn(noise, 128, 20);
  JpegEncoder encoder;
  const auto off = [&](int quality) {
    cv::Mat grey;
    cv::cvtColor(read_back(encoder.encode(Image(noise), 64, quality)), grey, cv::COLOR_BGR2GRAY);
    return cv::norm(grey, noise, cv::NORM_L1) / static_cast<double>(noise.total());
  };
  EXPECT_LT(off(98), 1);
  EXPECT_GT(off(JpegEncoder::kToBeObserved), 2);
}

TEST(Jpeg, OfNothingIsNothing) {
  EXPECT_TRUE(JpegEncoder().encode(Image(), 64).empty());
}

}  // namespace
}  // namespace marey::draw
