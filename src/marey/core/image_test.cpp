#include "marey/core/image.h"

#include <gtest/gtest.h>

namespace marey {
namespace {

double largest_difference(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_INF);
}

TEST(Image, ColourSurvivesTheWayThroughPlanes) {
  for (const cv::Size size : {cv::Size(8, 6), cv::Size(7, 5), cv::Size(1, 1)}) {
    const cv::Mat bgr(size, CV_8UC3, cv::Scalar(200, 120, 40));
    const Image image = Image::from_bgr(bgr);
    EXPECT_EQ(image.size(), size);
    EXPECT_TRUE(image.is_colour());
    EXPECT_LE(largest_difference(image.bgr(), bgr), 4) << size;
  }
}

TEST(Image, FullRangeIsBroughtToTheSameColours) {
  const cv::Size size(4, 4);
  const Image white(cv::Mat(size, CV_8UC1, cv::Scalar(255)), cv::Mat(2, 2, CV_8UC1, cv::Scalar(128)),
                    cv::Mat(2, 2, CV_8UC1, cv::Scalar(128)), Image::Range::full);
  EXPECT_LE(largest_difference(white.bgr(), cv::Mat(size, CV_8UC3, cv::Scalar::all(255))), 1);
}

TEST(Image, SixteenBitGreyIsScaled) {
  const Image grey(cv::Mat(3, 3, CV_16UC1, cv::Scalar(65535)));
  EXPECT_FALSE(grey.is_colour());
  EXPECT_EQ(largest_difference(grey.bgr(), cv::Mat(3, 3, CV_8UC3, cv::Scalar::all(255))), 0);
}

}  // namespace
}  // namespace marey
