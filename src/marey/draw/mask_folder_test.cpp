#include "marey/draw/mask_folder.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "marey/core/error.h"

#include "support/files.h"

namespace marey::draw {
namespace {

TEST(MaskFolder, ReadsBackAsGreyPicturesThatCountFromOne) {
  const test::TemporaryFolder folder;
  const std::string masks = folder / "deep/masks";
  cv::Mat mask(30, 41, CV_8UC1, cv::Scalar(0));
  mask(cv::Rect(3, 4, 10, 20)).setTo(255);
  {
    MaskFolder out(masks);
    out.add(0, {}, mask.size());
    out.add(7, mask, mask.size());
    out.finish();
  }
  const cv::Mat first = cv::imread(masks + "/bin000001.png", cv::IMREAD_UNCHANGED);
  ASSERT_EQ(first.size(), mask.size());
  EXPECT_EQ(cv::countNonZero(first), 0);
  const cv::Mat eighth = cv::imread(masks + "/bin000008.png", cv::IMREAD_UNCHANGED);
  ASSERT_EQ(eighth.type(), CV_8UC1);
  EXPECT_EQ(cv::norm(eighth, mask, cv::NORM_INF), 0);
  EXPECT_THROW(MaskFolder again(masks), Error);  // existing files stay
  EXPECT_TRUE(std::filesystem::exists(masks + "/bin000008.png"));
}

TEST(MaskFolder, HoldsNumbersOfTargets) {
  const test::TemporaryFolder folder;
  cv::Mat numbers(20, 30, CV_16UC1, cv::Scalar(0));
  numbers(cv::Rect(3, 4, 10, 8)).setTo(1234);
  {
    MaskFolder out(folder / "masks", "target");
    out.add(0, numbers, numbers.size());
    out.finish();
  }
  const cv::Mat read = cv::imread(folder / "masks/target000001.png", cv::IMREAD_UNCHANGED);
  ASSERT_EQ(read.type(), CV_16UC1);
  EXPECT_EQ(cv::norm(read, numbers, cv::NORM_INF), 0);
}

TEST(MaskFolder, LeavesNothingBehindUnfinished) {
  const test::TemporaryFolder folder;
  const std::string masks = folder / "masks";
  {
    MaskFolder(masks).add(0, {}, {8, 8});
  }
  EXPECT_FALSE(std::filesystem::exists(masks));
  std::ofstream(folder / "file") << "x";
  EXPECT_THROW(MaskFolder out(folder / "file"), Error);
}

}  // namespace
}  // namespace marey::draw
