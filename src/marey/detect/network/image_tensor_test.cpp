#include "marey/detect/network/image_tensor.h"

#include <gtest/gtest.h>

namespace marey::detect::network {
namespace {

TEST(ImageTensor, PlanesHoldTheChannelsInTheirOrder) {
  cv::Mat image(2, 3, CV_8UC3);
  for (int i = 0; i < 6; ++i) image.at<cv::Vec3b>(i / 3, i % 3) = {static_cast<unsigned char>(i), 100, 255};
  const cv::Mat rgb = image_tensor(image, ChannelOrder::rgb, {});
  const cv::Mat bgr = image_tensor(image, ChannelOrder::bgr, {.divisor = 127.5F, .summand = -1});
  ASSERT_EQ(rgb.dims, 4);
  EXPECT_EQ(std::vector<int>(rgb.size.p, rgb.size.p + 4), (std::vector<int>{1, 3, 2, 3}));
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(rgb.ptr<float>()[i], 1) << "red";
    EXPECT_EQ(rgb.ptr<float>()[6 + i], 100 / 255.0F);
    EXPECT_EQ(rgb.ptr<float>()[12 + i], static_cast<float>(i) / 255.0F);
    EXPECT_EQ(bgr.ptr<float>()[i], static_cast<float>(i) / 127.5F - 1) << "blue";
    EXPECT_EQ(bgr.ptr<float>()[12 + i], 1);
  }
}

TEST(ImageTensor, APartOfAnImageIsNotTaken) {
  const cv::Mat image(4, 4, CV_8UC3, cv::Scalar::all(7));
  EXPECT_THROW(image_tensor(image(cv::Rect(1, 1, 2, 2)), ChannelOrder::rgb, {}), cv::Exception);
}

}  // namespace
}  // namespace marey::detect::network
