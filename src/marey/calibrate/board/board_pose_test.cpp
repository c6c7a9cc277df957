#include "marey/calibrate/board/board_pose.h"

#include <gtest/gtest.h>

#include "marey/calibrate/board/board_scene_test.h"

namespace marey::calibrate::board {
namespace {

const std::vector<geometry::Lens> kLenses{geometry::BrownLens{{900, 910}, {640, 480}, {-0.2, 0.05, 0.001, -0.001, 0}},
                                          geometry::FisheyeLens{{500, 500}, {640, 480}, {0.02, -0.01, 0.003, 0}},
                                          geometry::TsaiLens{{900, 900}, {640, 480}, {-0.1}}};

Rigid3 before_the_camera(Noise& noise) {
  return {geometry::rotation_from({noise.uniform(-0.7, 0.7), noise.uniform(-0.7, 0.7), noise.uniform(-1, 1)}),
          {noise.uniform(-0.2, 0.1), noise.uniform(-0.2, 0.1), noise.uniform(0.6, 1.2)}};
}

TEST(BoardPose, IsFoundThroughEveryLens) {
  const Board board = parse_board("chess:8x6:0.03");
  for (const geometry::Lens& lens : kLenses) {
    const Camera camera(lens, {}, {1280, 960});
    int tried = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      SCOPED_TRACE(std::string(geometry::name_of(lens)) + " " + std::to_string(seed));
      Noise noise(seed);
      const Rigid3 truth = before_the_camera(noise);
      const auto view = observe_board(camera, board, [&](double) { return truth; }, 0, noise);
      if (!view) continue;
      ++tried;
      const auto pose = board_pose(board, *view, lens);
      ASSERT_TRUE(pose);
      EXPECT_LT((pose->rotation - truth.rotation).norm(), 1e-3);
      EXPECT_LT((pose->translation - truth.translation).norm(), 1e-3);
      EXPECT_LT(*board_rms(board, *view, lens, *pose), 0.05);
    }
    EXPECT_GE(tried, 8);
  }
}

TEST(BoardPose, IsFoundFromBehindTheBoard) {
  const Board board = parse_board("charuco:8x6:0.04:0.03:4X4_50");
  const Camera camera(kLenses[0], {}, {1280, 960});
  const Matrix<3> about = Vector<3>(-1, 1, -1).asDiagonal();
  int tried = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Noise noise(seed);
    const Rigid3 front = before_the_camera(noise);
    const Rigid3 truth{front.rotation * about, front.translation + front.rotation * Vector<3>(0.2, 0, 0)};
    const auto view = observe_board(camera, board, [&](double) { return truth; }, 0, noise);
    if (!view) continue;
    ++tried;
    const auto pose = board_pose(board, *view, kLenses[0]);
    ASSERT_TRUE(pose) << seed;
    EXPECT_LT((pose->rotation - truth.rotation).norm(), 1e-3) << seed;
    EXPECT_LT((pose->translation - truth.translation).norm(), 1e-3) << seed;
  }
  EXPECT_GE(tried, 8);
}

TEST(BoardPose, FewCornersOrALineGiveNone) {
  const Board board = parse_board("chess:8x6:0.03");
  const Camera camera(kLenses[0], {}, {1280, 960});
  Noise noise(3);
  const BoardView whole = *observe_board(camera, board, [](double) { return Rigid3{Matrix<3>::Identity(), {0, 0, 1}}; }, 0, noise);
  BoardView three, row;
  for (const int id : {0, 7, 40}) three.corners.push_back(whole.corners[static_cast<std::size_t>(id)]);
  for (std::size_t id = 0; id < 8; ++id) row.corners.push_back(whole.corners[id]);
  EXPECT_TRUE(board_pose(board, whole, kLenses[0]));
  EXPECT_FALSE(board_pose(board, three, kLenses[0]));
  EXPECT_FALSE(board_pose(board, row, kLenses[0]));
  EXPECT_FALSE(board_pose(board, {}, kLenses[0]));
}

TEST(BoardPose, TheRmsIsTheDistanceOfTheCorners) {
  const Board board = parse_board("chess:4x3:0.05");
  const Camera camera(kLenses[0], {}, {1280, 960});
  const Rigid3 pose{Matrix<3>::Identity(), {-0.05, -0.05, 1}};
  Noise noise(4);
  BoardView view = *observe_board(camera, board, [&](double) { return pose; }, 0, noise);
  EXPECT_NEAR(*board_rms(board, view, kLenses[0], pose), 0, 1e-9);
  for (BoardCorner& corner : view.corners) corner.pixel += Vector<2>(3, 4);
  EXPECT_NEAR(*board_rms(board, view, kLenses[0], pose), 5, 1e-9);
  EXPECT_FALSE(board_rms(board, view, kLenses[0], {Matrix<3>::Identity(), {0, 0, -1}})) << "behind the camera";
}

TEST(PixelOf, AgreesWithTheCameraAndIsNothingBehindIt) {
  for (const geometry::Lens& lens : kLenses) {
    const Camera camera(lens, {}, {1280, 960});
    Noise noise(5);
    for (int i = 0; i < 100; ++i) {
      const Vector<3> point(noise.uniform(-0.3, 0.3), noise.uniform(-0.3, 0.3), noise.uniform(0.8, 3));
      EXPECT_LT((*pixel_of(lens, point) - *camera.project(point)).norm(), 1e-9);
    }
  }
  EXPECT_FALSE(pixel_of(kLenses[0], {0, 0, -1}));
  EXPECT_FALSE(pixel_of(kLenses[2], {0.1, 0, 0}));
  EXPECT_TRUE(pixel_of(kLenses[1], {1, 0, -0.1})) << "a fisheye sees behind itself";
}

}  // namespace
}  // namespace marey::calibrate::board
