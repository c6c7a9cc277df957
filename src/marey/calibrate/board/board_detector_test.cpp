#include "marey/calibrate/board/board_detector.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/calibrate/board/board_dictionary.h"
#include "marey/calibrate/board/board_scene_test.h"

namespace marey::calibrate::board {
namespace {

constexpr int kSide = 60;    // px of a square in the drawing
constexpr int kMargin = 40;  // px of white round it

/// The board as printed; `inverted` as it asks.
cv::Mat drawn(const Board& board) {
  const int columns = board.corners.width + 1, rows = board.corners.height + 1;
  cv::Mat picture(rows * kSide + 2 * kMargin, columns * kSide + 2 * kMargin, CV_8UC1, cv::Scalar(255));
  int marker = 0;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      cv::Mat square = picture(cv::Rect(kMargin + x * kSide, kMargin + y * kSide, kSide, kSide));
      if ((x + y) % 2 == 0) square.setTo(0);
      if ((x + y) % 2 == 0 || board.kind == Board::Kind::chess) continue;
      const int side = static_cast<int>(std::lround(kSide * board.marker_m / board.square_m)), rim = (kSide - side) / 2;
      cv::Mat code;
      cv::aruco::drawMarker(board_dictionary(board.dictionary), marker++, side, code);
      code.copyTo(square(cv::Rect(rim, rim, side, side)));
    }
  }
  if (board.inverted) cv::bitwise_not(picture, picture);
  return picture;
}

/// Seen at a slant, a little blurred, with noise; and where the corners are then.
struct Seen {
  cv::Mat picture;
  cv::Matx33d picture_from_drawing;

  Vector<2> corner(const Board& board, int id) const {
    const double x = kMargin + kSide * (1 + id % board.corners.width) - 0.5,
                 y = kMargin + kSide * (1 + id / board.corners.width) - 0.5;
    const cv::Vec3d p = picture_from_drawing * cv::Vec3d(x, y, 1);
    return {p[0] / p[2], p[1] / p[2]};
  }
};

Seen seen(const Board& board, bool upside_down = false) {
  const cv::Mat flat = drawn(board);
  const double w = flat.cols, h = flat.rows;
  const std::vector<cv::Point2f> from{
      {0, 0}, {static_cast<float>(w), 0}, {static_cast<float>(w), static_cast<float>(h)}, {0, static_cast<float>(h)}};
  std::vector<cv::Point2f> to{{150, 90}, {700, 130}, {640, 560}, {110, 500}};
  if (upside_down) std::rotate(to.begin(), to.begin() + 2, to.end());
  Seen result;
  result.picture_from_drawing = cv::Matx33d(cv::getPerspectiveTransform(from, to));
  cv::warpPerspective(flat, result.picture, result.picture_from_drawing, {800, 640}, cv::INTER_AREA, cv::BORDER_CONSTANT,
                      cv::Scalar(128));
  cv::GaussianBlur(result.picture, result.picture, {}, 0.8);
  Noise noise(5);
  for (auto it = result.picture.begin<unsigned char>(); it != result.picture.end<unsigned char>(); ++it)
    *it = cv::saturate_cast<unsigned char>(*it + noise.gaussian(2));
  return result;
}

void expect_found(const Board& board, const Seen& scene, int least) {
  const auto view = BoardDetector(board).detect(Picture(scene.picture));
  ASSERT_TRUE(view) << to_string(board);
  EXPECT_GE(static_cast<int>(view->corners.size()), least);
  double square = 0;
  for (const BoardCorner& corner : view->corners) square += (corner.pixel - scene.corner(board, corner.id)).squaredNorm();
  EXPECT_LT(std::sqrt(square / static_cast<double>(view->corners.size())), 0.15) << to_string(board);
}

TEST(BoardDetector, FindsEveryKindToAFractionOfAPixel) {
  for (const char* text :
       {"chess:8x5:0.03", "chess:8x5:0.03:inverted", "charuco:8x6:0.04:0.03:4X4_50", "charuco:7x5:0.04:0.03:5X5_100:inverted"}) {
    const Board board = parse_board(text);
    expect_found(board, seen(board), board.corner_count());
  }
}

TEST(BoardDetector, CornerZeroIsTheSameUpsideDown) {
  for (const char* text : {"chess:8x5:0.03", "charuco:8x6:0.04:0.03:4X4_50"}) {
    const Board board = parse_board(text);
    expect_found(board, seen(board, true), board.corner_count());
  }
}

TEST(BoardDetector, ACharucoOnGlassIsFoundFromBehind) {
  for (const char* text :
       {"charuco:8x6:0.04:0.03:4X4_50", "charuco:7x5:0.04:0.03:5X5_100:inverted", "charuco:4x5:0.05:0.04:4X4_1000"}) {
    const Board board = parse_board(text);
    for (const bool upside_down : {false, true}) {
      Seen scene = seen(board, upside_down);
      cv::flip(scene.picture, scene.picture, 1);
      scene.picture_from_drawing = cv::Matx33d(-1, 0, scene.picture.cols - 1, 0, 1, 0, 0, 0, 1) * scene.picture_from_drawing;
      expect_found(board, scene, board.corner_count());
      scene.picture(cv::Rect(450, 0, 350, 640)).setTo(90);  // a part of it hidden
      expect_found(board, scene, 4);
    }
  }
}

TEST(BoardDetector, AHiddenPartOfACharucoIsLeftOut) {
  const Board board = parse_board("charuco:8x6:0.04:0.03:4X4_50");
  Seen scene = seen(board);
  scene.picture(cv::Rect(0, 0, 330, 640)).setTo(90);
  expect_found(board, scene, 6);
  const auto view = BoardDetector(board).detect(Picture(scene.picture));
  for (const BoardCorner& corner : view->corners) EXPECT_GT(corner.pixel.x(), 325);
}

TEST(BoardDetector, NothingIsFoundWhereThereIsNoSuchBoard) {
  const Seen scene = seen(parse_board("chess:8x5:0.03"));
  EXPECT_FALSE(BoardDetector(parse_board("chess:9x6:0.03")).detect(Picture(scene.picture)));
  EXPECT_FALSE(BoardDetector(parse_board("charuco:8x6:0.04:0.03:4X4_50")).detect(Picture(scene.picture)));
  EXPECT_FALSE(BoardDetector(parse_board("chess:9x6:0.03")).detect(Picture(cv::Mat(480, 640, CV_8UC1, cv::Scalar(7)))));
  EXPECT_FALSE(BoardDetector(parse_board("chess:9x6:0.03")).detect(Picture()));
}

}  // namespace
}  // namespace marey::calibrate::board
