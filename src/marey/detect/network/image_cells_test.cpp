#include "marey/detect/network/image_cells.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace marey::detect::network {
namespace {

ImageCells scene(double noise, std::uint64_t seed, const cv::Rect& person) {
  cv::Mat grey(576, 768, CV_8UC1, cv::Scalar(110));
  if (person.area() > 0) grey(person) = cv::Scalar(60);
  cv::Mat sum;
  grey.convertTo(sum, CV_16S);
  cv::Mat random(grey.size(), CV_16S);
  cv::RNG(seed).fill(random, cv::RNG::NORMAL, 0, noise);
  cv::add(sum, random, sum);
  sum.convertTo(grey, CV_8U);
  return cells_of(Image(grey));
}

TEST(ImageCells, NoiseChangesNothingAndAPersonDoes) {
  const cv::Rect there(300, 200, 30, 80);
  const ImageCells before = scene(6, 1, {}), noisy = scene(6, 2, {}), now = scene(6, 3, there);
  EXPECT_TRUE(changed_parts(before, noisy, {}).empty());
  const std::vector<Box> parts = changed_parts(before, now, {});
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_GT(geometry::iou(parts[0], {300, 200, 30, 80}), 0.6);
  EXPECT_TRUE(changed_parts(before, now, std::vector<Box>{{290, 190, 50, 100}}).empty()) << "explained";
  EXPECT_FALSE(is_unchanged(before, now, {310, 150, 40, 90}));
  EXPECT_TRUE(is_unchanged(before, now, {500, 150, 40, 90}));
}

TEST(ImageCells, ChangesEverywhereWithoutAnEarlierPicture) {
  const ImageCells now = scene(0, 1, {});
  ASSERT_EQ(changed_parts({}, now, {}).size(), 1u);
  EXPECT_GT(changed_parts({}, now, {})[0].area(), 0.9 * 768 * 576);
  EXPECT_FALSE(is_unchanged({}, now, {0, 0, 10, 10}));
}

}  // namespace
}  // namespace marey::detect::network
