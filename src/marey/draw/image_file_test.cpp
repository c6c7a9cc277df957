#include "marey/draw/image_file.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "marey/core/error.h"

#include "support/files.h"

namespace marey::draw {
namespace {

TEST(PictureFile, ReadsBackAsItWasWritten) {
  cv::Mat bgr(60, 82, CV_8UC3);
  for (int y = 0; y < bgr.rows; ++y) {
    for (int x = 0; x < bgr.cols; ++x) bgr.at<cv::Vec3b>(y, x) = cv::Vec3b(x * 2, y * 3, 128);
  }
  const Image image = Image::from_bgr(bgr);
  const test::TemporaryFolder folder;
  for (const auto& [name, tolerance] : {std::pair{"a.png", 1.0}, {"a.jpg", 4.0}}) {
    const std::string path = folder / name;
    write_image(path, image);
    const cv::Mat read = cv::imread(path);
    ASSERT_EQ(read.size(), bgr.size()) << name;
    EXPECT_LT(cv::norm(read, image.bgr(), cv::NORM_L1) / (bgr.total() * 3.0), tolerance) << name;
  }
}

TEST(PictureFile, NowhereToWriteIsSaid) {
  EXPECT_THROW(write_image("/nonexistent/a.png", Image(cv::Mat(4, 4, CV_8UC1, cv::Scalar(7)))), Error);
}

}  // namespace
}  // namespace marey::draw
