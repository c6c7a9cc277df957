#include "marey/detect/network/tiles.h"

#include <random>

#include <gtest/gtest.h>

#include "marey/geometry/box.h"

namespace marey::detect::network {
namespace {

TEST(Tiles, EverybodyLiesWholeInATileWhereHeFillsAGoodShareOfIt) {
  const cv::Size picture(1920, 1080);
  const HeightAt height_at = [](double, double y) -> std::optional<double> {
    if (y < 200) return std::nullopt;
    return 0.22 * y;
  };
  const std::vector<cv::Rect> tiles = tiles_over(picture, height_at, 80);
  std::mt19937 random(5);
  for (int i = 0; i < 500; ++i) {
    const double x = std::uniform_real_distribution<double>(60, 1860)(random),
                 y = std::uniform_real_distribution<double>(250, 1075)(random);
    const double height = 0.22 * y;
    const cv::Rect2d person(x - height / 6, y - height, height / 3, height);
    bool good = false;
    for (const cv::Rect& tile : tiles) {
      const double share = height / tile.height;
      good |= (person & cv::Rect2d(tile)).area() > 0.999 * person.area() && share > 0.18 && share < 0.42;
    }
    EXPECT_TRUE(good) << "seed 5: " << x << ", " << y << ", " << height << " px high";
  }
  for (const cv::Rect& tile : tiles) EXPECT_EQ(tile & cv::Rect(cv::Point(), picture), tile);
}

TEST(Tiles, ASmallPictureIsOneTile) {
  const std::vector<cv::Rect> tiles = tiles_over({200, 200}, {}, 80);
  ASSERT_EQ(tiles.size(), 1U);
  EXPECT_EQ(tiles[0], cv::Rect(0, 0, 200, 200));
}

TEST(JoinFinds, TwoTilesSeeOnePersonOnceAndWhoIsCutOffNotAtAll) {
  const cv::Size picture(500, 300);
  const std::vector<TileFinds> tiles = {{{0, 0, 300, 300}, {{210, 100, 250, 200, 0.9}, {270, 50, 299, 150, 0.8}}},
                                        {{200, 0, 300, 300}, {{212, 98, 251, 203, 0.7}, {268, 50, 310, 150, 0.6}}}};
  const std::vector<Candidate> joined = join_finds(tiles, picture);
  ASSERT_EQ(joined.size(), 2U);
  EXPECT_EQ(joined[0].score, 0.9);
  EXPECT_EQ(joined[0].right, 250) << "the surer find";
  EXPECT_EQ(joined[1].score, 0.6) << "one tile alone holds it whole";
  EXPECT_EQ(joined[1].right, 310);
}

}  // namespace
}  // namespace marey::detect::network
