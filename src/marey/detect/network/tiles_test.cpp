#include "marey/detect/network/tiles.h"

#include <random>

#include <gtest/gtest.h>

#include "marey/geometry/box.h"

namespace marey::detect::network {
namespace {

TEST(Tiles, EverybodyLiesWholeInATileWhereHeFillsAGoodShareOfIt) {
  const cv::Size image(1920, 1080);
  const HeightAt height_at = [](double, double y) -> std::optional<double> {
    if (y < 200) return std::nullopt;
    return 0.22 * y;
  };
  const std::vector<cv::Rect> tiles = tiles_over(image, height_at, 80);
  std::mt19937 random(5);
  for (int i = 0; i < 500; ++i) {
    const double x = std::uniform_real_distribution<double>(60, 1860)(random),
                 y = std::uniform_real_distribution<double>(250, 1075)(random);
    const double height = 0.22 * y;
    const cv::Rect2d person(x - height / 6, y - height, height / 3, height);
    bool good = false;
    for (const cv::Rect& tile : tiles) {
      const double fraction = height / tile.height;
      good |= (person & cv::Rect2d(tile)).area() > 0.999 * person.area() && fraction > 0.18 && fraction < 0.42;
    }
    EXPECT_TRUE(good) << "seed 5: " << x << ", " << y << ", " << height << " px high";
  }
  for (const cv::Rect& tile : tiles) EXPECT_EQ(tile & cv::Rect(cv::Point(), image), tile);
}

TEST(Tiles, ASmallPictureIsOneTile) {
  const std::vector<cv::Rect> tiles = tiles_over({200, 200}, {}, 80);
  ASSERT_EQ(tiles.size(), 1U);
  EXPECT_EQ(tiles[0], cv::Rect(0, 0, 200, 200));
}

TEST(Tiles, SearchEverySizeWhereNoneIsKnown) {
  const cv::Size image(768, 432);
  const std::vector<cv::Rect> tiles = tiles_over(image, {}, 84);
  for (const double height : {60.0, 84.0, 200.0, 410.0}) {
    const cv::Rect2d person(350, 428 - height, height / 3, height);
    bool good = false;
    for (const cv::Rect& tile : tiles)
      good |= (person & cv::Rect2d(tile)).area() > 0.999 * person.area() && height / tile.height > 0.18;
    EXPECT_TRUE(good) << height << " px high";
  }
}

TEST(Tiles, RoundPeopleAreFewAndHoldEachWhole) {
  const cv::Size image(768, 576);
  std::mt19937 random(7);
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<Box> people;
    for (int i = 0; i < 6; ++i) {
      const double height = std::uniform_real_distribution<double>(40, 140)(random);
      people.push_back({std::uniform_real_distribution<double>(0, 768 - height / 3)(random),
                        std::uniform_real_distribution<double>(0, 576 - height)(random), height / 3, height});
    }
    const std::vector<cv::Rect> tiles = tiles_round(image, people);
    EXPECT_LE(tiles.size(), people.size());
    for (const Box& one : people) {
      bool good = false;
      for (const cv::Rect& tile : tiles) {
        const cv::Rect2d person(one.left, one.top, one.width, one.height);
        good |= (person & cv::Rect2d(tile)).area() > 0.999 * person.area() && one.height > 0.17 * tile.height;
      }
      EXPECT_TRUE(good) << "seed 7, trial " << trial;
    }
    for (const cv::Rect& tile : tiles) EXPECT_EQ(tile & cv::Rect(cv::Point(), image), tile);
  }
  const std::vector<Box> together = {{100, 100, 30, 80}, {140, 105, 30, 78}, {170, 98, 28, 82}};
  EXPECT_EQ(tiles_round(image, together).size(), 1u);
  EXPECT_TRUE(tiles_round(image, {}).empty());
}

TEST(JoinFinds, ABoxThatSpansTwoPeopleIsNeitherOfThem) {
  const cv::Size image(500, 300);
  // Two people side by side, 50 px in all, and a box round both that the network is surest of; another over halves of both.
  const std::vector<TileFinds> tiles = {
      {{0, 0, 300, 300},
       {{100, 100, 152, 190, 0.7}, {100, 102, 127, 188, 0.65}, {125, 100, 152, 190, 0.62}, {112, 100, 140, 190, 0.5}}}};
  const std::vector<Candidate> joined = join_finds(tiles, image);
  ASSERT_EQ(joined.size(), 2U);
  EXPECT_EQ(joined[0].score, 0.65);
  EXPECT_EQ(joined[1].score, 0.62);
}

TEST(JoinFinds, TwoTilesSeeOnePersonOnceAndWhoIsCutOffNotAtAll) {
  const cv::Size image(500, 300);
  const std::vector<TileFinds> tiles = {{{0, 0, 300, 300}, {{210, 100, 250, 200, 0.9}, {270, 50, 299, 150, 0.8}}},
                                        {{200, 0, 300, 300}, {{212, 98, 251, 203, 0.7}, {268, 50, 310, 150, 0.6}}}};
  const std::vector<Candidate> joined = join_finds(tiles, image);
  ASSERT_EQ(joined.size(), 2U);
  EXPECT_EQ(joined[0].score, 0.9);
  EXPECT_EQ(joined[0].right, 250) << "the surer find";
  EXPECT_EQ(joined[1].score, 0.6) << "one tile alone holds it whole";
  EXPECT_EQ(joined[1].right, 310);
}

}  // namespace
}  // namespace marey::detect::network
