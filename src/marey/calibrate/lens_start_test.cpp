#include "marey/calibrate/lens_start.h"

#include <gtest/gtest.h>

#include "marey/calibrate/board/board_scene_test.h"
#include "marey/core/error.h"

namespace marey::calibrate {
namespace {

const cv::Size kSize(1280, 960);

/// The board before a lens, turned each time.
std::vector<LensView> views_of(const board::Board& board, const geometry::Lens& lens, int count, std::uint64_t seed) {
  board::Noise noise(seed);
  std::vector<LensView> views;
  while (static_cast<int>(views.size()) < count) {
    const Vector<3> turn(noise.uniform(-0.6, 0.6), noise.uniform(-0.6, 0.6), noise.uniform(-0.6, 0.6));
    const Rigid3 pose{geometry::rotation_from(turn), {noise.uniform(-0.2, 0), noise.uniform(-0.2, 0), noise.uniform(0.5, 1)}};
    const Camera camera(lens, {}, kSize);
    if (const auto view = board::observe_board(camera, board, [&](double) { return pose; }, 0.2, noise))
      views.push_back({"", *view});
  }
  return views;
}

TEST(FirstLens, FindsTheFocalLengthOfEveryModelWithinAStep) {
  const auto board = board::parse_board("chess:8x6:0.03");
  for (const std::string& model : lens_models()) {
    SCOPED_TRACE(model);
    const double focal = model == "brown" ? 1500 : 900;
    const auto lens = first_lens(board, kSize, views_of(board, plain_lens(model, focal, {639.5, 479.5}), 6, 7), model);
    ASSERT_TRUE(lens);
    EXPECT_NEAR(geometry::focal_of(*lens).x() / focal, 1, 0.15);
    EXPECT_EQ(geometry::name_of(*lens), model);
  }
}

TEST(FirstLens, NothingWhereNoViewGivesAPose) {
  const auto board = board::parse_board("chess:8x6:0.03");
  LensView view;
  for (int id = 0; id < 3; ++id) view.board.corners.push_back({id, {100.0 + 50 * id, 100}});
  EXPECT_FALSE(first_lens(board, kSize, std::vector{view}, "brown"));
}

TEST(PlainLens, AnUnknownModelIsRefusedWithTheKnownOnes) {
  try {
    plain_lens("pinhole", 1000, {0, 0});
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("brown, fisheye, tsai"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace marey::calibrate
