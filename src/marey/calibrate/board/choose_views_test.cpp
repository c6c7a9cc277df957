#include "marey/calibrate/board/choose_views.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "marey/calibrate/board/board_scene_test.h"

namespace marey::calibrate::board {
namespace {

const cv::Size kSize(1280, 960);

/// A board of 6 × 5 corners as a rectangle of `width` × `height` px with its corner at (`x`, `y`).
BoardView rectangle(double x, double y, double width, double height) {
  BoardView view;
  for (int id = 0; id < 30; ++id) view.corners.push_back({id, {x + width * (id % 6) / 5, y + height * (id / 6) / 4}});  // NOLINT
  return view;
}

std::vector<std::size_t> chosen(const std::vector<BoardView>& views, const std::vector<double>& sharpness, std::size_t maximum) {
  std::vector<ViewCandidate> candidates;
  for (std::size_t i = 0; i < views.size(); ++i) candidates.push_back({&views[i], sharpness[i]});
  return choose_views(candidates, kSize, maximum);
}

TEST(ChooseViews, DifferentViewsComeBeforeMoreOfTheSame) {
  std::vector<BoardView> views;
  for (int i = 0; i < 10; ++i) views.push_back(rectangle(100 + i, 100, 300, 250));  // ten times nearly the same
  views.push_back(rectangle(800, 600, 300, 250));
  views.push_back(rectangle(100, 600, 600, 100));
  const auto taken = chosen(views, std::vector<double>(12, 0.5), 3);
  ASSERT_EQ(taken.size(), 3U);
  EXPECT_EQ(taken[1], 10U);
  EXPECT_EQ(taken[2], 11U);
}

TEST(ChooseViews, BlurredOnesAreLeftOut) {
  std::vector<BoardView> views;
  std::vector<double> sharpness;
  for (int i = 0; i < 12; ++i) {
    views.push_back(rectangle(80.0 * i, 50.0 * i, 250, 200));
    sharpness.push_back(i % 4 == 0 ? 0.2 : 0.6);
  }
  for (const std::size_t i : chosen(views, sharpness, 12)) EXPECT_NE(i % 4, 0U);
  EXPECT_EQ(chosen(views, sharpness, 12).size(), 9U) << "all that are sharp";
}

TEST(ChooseViews, TheSharperOfTwoAlikeIsTaken) {
  const std::vector<BoardView> views{rectangle(300, 300, 300, 250), rectangle(300, 300, 300, 250)};
  EXPECT_EQ(chosen(views, {0.5, 0.6}, 1), std::vector<std::size_t>{1});
  EXPECT_EQ(chosen(views, {0.6, 0.5}, 1), std::vector<std::size_t>{0});
}

TEST(ChooseViews, AreRisingOnceEachAndNoMoreThanAskedFor) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Noise noise(seed);
    std::vector<BoardView> views;
    std::vector<double> sharpness;
    for (int i = 0; i < 40; ++i) {
      views.push_back(rectangle(noise.uniform(0, 700), noise.uniform(0, 600), noise.uniform(50, 500), noise.uniform(50, 300)));
      sharpness.push_back(noise.uniform(0.4, 0.8));
    }
    const auto taken = chosen(views, sharpness, 15);
    EXPECT_EQ(taken.size(), 15U);
    EXPECT_TRUE(std::is_sorted(taken.begin(), taken.end()));
    EXPECT_EQ(std::adjacent_find(taken.begin(), taken.end()), taken.end());
    EXPECT_EQ(taken, chosen(views, sharpness, 15)) << "the same every time";
  }
  EXPECT_TRUE(chosen({}, {}, 5).empty());
}

}  // namespace
}  // namespace marey::calibrate::board
