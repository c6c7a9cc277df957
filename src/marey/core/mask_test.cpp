#include "marey/core/mask.h"

#include <random>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace marey {
namespace {

TEST(Mask, IsARectangleByFourNumbersAndAPolygonByItsCorners) {
  const std::vector<int> rectangle{3, 5, 10, 20}, triangle{10, 20, 40, 20, 10, 60};
  EXPECT_EQ(Mask::of_numbers(rectangle), Mask(3, 5, 10, 20));
  EXPECT_EQ(Mask::of_numbers(rectangle)->numbers(), rectangle);
  const auto polygon = Mask::of_numbers(triangle);
  ASSERT_TRUE(polygon);
  EXPECT_EQ(polygon->corners().size(), 3u);
  EXPECT_EQ(polygon->box(), cv::Rect(10, 20, 31, 41)) << "corners are pixels of it";
  EXPECT_EQ(polygon->numbers(), triangle);
  EXPECT_NE(*polygon, Mask(10, 20, 31, 41));
}

TEST(Mask, OtherNumbersAreNone) {
  for (const std::vector<int>& numbers : {std::vector<int>{},
                                          {1, 2, 3},
                                          {1, 2, 0, 4},
                                          {-1, 2, 3, 4},
                                          {1, 2, 3, 4, 5},
                                          {1, 2, 3, 4, 5, 6, 7},
                                          {1, 2, 3, 4, 5, -6},
                                          {1, 2, 3, 4, 5, 100'001},
                                          std::vector<int>(2 * Mask::kMaxCorners + 2, 7)})
    EXPECT_FALSE(Mask::of_numbers(numbers));
  EXPECT_TRUE(Mask::of_numbers(std::vector<int>(2 * Mask::kMaxCorners, 7)));
}

TEST(Mask, APolygonHoldsWhatIsFilledOfIt) {
  const unsigned seed = std::random_device{}();
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> location(0, 63), count(3, 9);
  for (int round = 0; round < 200; ++round) {
    std::vector<cv::Point> corners;
    for (int i = count(random); i > 0; --i) corners.emplace_back(location(random), location(random));
    const Mask mask = Mask::polygon(corners);
    cv::Mat filled(64, 64, CV_8UC1, cv::Scalar(0)), edges(64, 64, CV_8UC1, cv::Scalar(0));
    const std::vector<std::vector<cv::Point>> outline{corners};
    cv::fillPoly(filled, outline, cv::Scalar(255));
    cv::polylines(edges, outline, true, cv::Scalar(255), 3);  // where both may round differently
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x) {
        if (edges.at<std::uint8_t>(y, x) != 0) continue;
        ASSERT_EQ(mask.contains({x, y}), filled.at<std::uint8_t>(y, x) != 0) << x << ", " << y << ", seed " << seed;
      }
    }
    for (const cv::Point& corner : corners) ASSERT_TRUE(mask.contains({corner.x, corner.y})) << "seed " << seed;
  }
}

TEST(Mask, ScaledACornerStaysWhereItWas) {
  const Mask triangle = Mask::polygon({{10, 20}, {40, 20}, {10, 60}});
  EXPECT_EQ(triangle.scaled(2), Mask::polygon({{21, 41}, {81, 41}, {21, 121}})) << "the pixel's middle";
  EXPECT_EQ(triangle.scaled(2).scaled(0.5), triangle);
  EXPECT_EQ(Mask(3, 5, 10, 20).scaled(0.5), Mask(1, 2, 6, 11)) << "nothing of a rectangle is lost";
}

}  // namespace
}  // namespace marey
