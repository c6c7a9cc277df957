#include "marey/detect/keypoints/person_region.h"

#include <gtest/gtest.h>

namespace marey::detect::keypoints {
namespace {

TEST(PersonRegion, OfABoxHoldsItUpright) {
  const PersonRegion region = region_of(Box{100, 50, 40, 120});
  EXPECT_EQ(region.angle, 0);
  EXPECT_DOUBLE_EQ(region.side, 150);
  EXPECT_EQ(region.in_image({128, 128}), Vector<2>(119.5, 109.5));
}

TEST(PersonRegion, TurnsWithThePerson) {
  const PersonRegion region = region_of(Vector<2>(200, 100), Vector<2>(260, 100));  // lies with the head to the right
  EXPECT_DOUBLE_EQ(region.side, 150);
  EXPECT_LT((region.in_image({128, 128 - 60 / region.scale()}) - Vector<2>(260, 100)).norm(), 1e-9)
      << "the crop's up is the head's side";
}

/// An image whose blue is the column and green the row.
cv::Mat locations(cv::Size size) {
  cv::Mat image(size, CV_8UC3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) image.at<cv::Vec3b>(y, x) = {static_cast<uchar>(x), static_cast<uchar>(y), 0};
  }
  return image;
}

TEST(PersonRegion, ACropsPixelsAreThePicturesAtTheirPlace) {
  const cv::Mat image = locations({240, 240});
  for (const double side : {90.0, 256.0, 130.0}) {
    for (const double angle : {0.0, 0.7, -2.5}) {
      const PersonRegion region{.centre = {120.3, 118.6}, .side = side, .angle = angle};
      const cv::Mat crop = crop_of(image, region);
      ASSERT_EQ(crop.size(), cv::Size(256, 256));
      for (const cv::Point at : {cv::Point(128, 128), cv::Point(60, 200), cv::Point(128, 70), cv::Point(180, 128)}) {
        const Vector<2> location = region.in_image({at.x + 0.5, at.y + 0.5});
        if (location.x() < 1 || location.y() < 1 || location.x() > 238 || location.y() > 238) continue;
        EXPECT_NEAR(crop.at<cv::Vec3b>(at)[0], location.x(), 1.01) << side << " " << angle;
        EXPECT_NEAR(crop.at<cv::Vec3b>(at)[1], location.y(), 1.01) << side << " " << angle;
      }
    }
  }
}

TEST(PersonRegion, ALargeRegionIsAveragedAtItsPlaceToo) {
  cv::Mat image = cv::Mat::zeros(2000, 1600, CV_8UC3);
  image(cv::Rect(900, 1200, 40, 40)).setTo(cv::Scalar::all(255));
  const PersonRegion region{.centre = {800, 1000}, .side = 1900, .angle = 0.3};
  const cv::Mat crop = crop_of(image, region);
  Vector<2> sum = Vector<2>::Zero();
  double weight = 0;
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x)
      sum += crop.at<cv::Vec3b>(y, x)[0] * Vector<2>(x + 0.5, y + 0.5), weight += crop.at<cv::Vec3b>(y, x)[0];
  }
  EXPECT_LT((region.in_image(sum / weight) - Vector<2>(919.5, 1219.5)).norm(), 0.5);
}

TEST(PersonRegion, OfACamerasImageIsAtItsPlaceHowEverLarge) {
  cv::Mat bgr = cv::Mat::zeros(2001, 1603, CV_8UC3);
  bgr(cv::Rect(900, 1200, 41, 41)).setTo(cv::Scalar::all(255));
  const Image image = Image::from_bgr(bgr);
  for (const double side : {300.0, 600.0, 900.0, 1900.0}) {
    const PersonRegion region{.centre = {903.7, 1201.2}, .side = side, .angle = 0.3};
    const cv::Mat crop = crop_of(image, region);
    Vector<2> sum = Vector<2>::Zero();
    double weight = 0;
    for (int y = 0; y < 256; ++y) {
      for (int x = 0; x < 256; ++x)
        sum += crop.at<cv::Vec3b>(y, x)[0] * Vector<2>(x + 0.5, y + 0.5), weight += crop.at<cv::Vec3b>(y, x)[0];
    }
    EXPECT_LT((region.in_image(sum / weight) - Vector<2>(920, 1220)).norm(), 0.4) << side;
  }
}

TEST(PersonRegion, BeyondThePictureIsNoCrash) {
  const cv::Mat image = locations({240, 240});
  EXPECT_EQ(crop_of(image, {.centre = {-500, 100}, .side = 50, .angle = 0}).size(), cv::Size(256, 256));
  EXPECT_EQ(crop_of(image, {.centre = {0, 0}, .side = 4000, .angle = 1}).size(), cv::Size(256, 256));
}

}  // namespace
}  // namespace marey::detect::keypoints
