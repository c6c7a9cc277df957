#include "marey/detect/network/halved_image.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace marey::detect::network {
namespace {

/// Colours that change slowly to the right and down.
cv::Mat slope(int rows, int columns) {
  cv::Mat bgr(rows, columns, CV_8UC3);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x)
      bgr.at<cv::Vec3b>(y, x) = {static_cast<unsigned char>(60 + x), static_cast<unsigned char>(60 + y),
                                 static_cast<unsigned char>(120 + x - y)};
  }
  return bgr;
}

TEST(HalvedImage, HasTheMeansAtTheirPlaces) {
  const Image whole = Image::from_bgr(slope(40, 60)), half = halved(whole);
  ASSERT_EQ(half.size(), cv::Size(30, 20));
  const cv::Mat before = whole.bgr(), after = half.bgr();
  for (int y = 2; y < 18; ++y) {
    for (int x = 2; x < 28; ++x) {
      const cv::Scalar due = cv::mean(before(cv::Rect(2 * x, 2 * y, 2, 2)));
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(after.at<cv::Vec3b>(y, x)[c], due[c], 6) << x << ", " << y << ", " << c;
    }
  }
}

TEST(HalvedImage, OfOddSizesAndGrey) {
  EXPECT_EQ(halved(Image::from_bgr(slope(41, 63))).size(), cv::Size(31, 20));
  EXPECT_EQ(halved(Image::from_bgr(slope(7, 5))).bgr().size(), cv::Size(2, 3));
  EXPECT_EQ(halved(Image::from_bgr(slope(1, 1))).size(), cv::Size(1, 1));
  const cv::Mat grey(10, 12, CV_16UC1, cv::Scalar(40000));
  const Image half = halved(Image(grey));
  ASSERT_EQ(half.size(), cv::Size(6, 5));
  EXPECT_EQ(half.luma().at<unsigned short>(2, 3), 40000);
}

}  // namespace
}  // namespace marey::detect::network
