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
  cv::Mat image(rows * kSide + 2 * kMargin, columns * kSide + 2 * kMargin, CV_8UC1, cv::Scalar(255));
  int marker = 0;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      cv::Mat square = image(cv::Rect(kMargin + x * kSide, kMargin + y * kSide, kSide, kSide));
      if ((x + y) % 2 == 0) square.setTo(0);
      if ((x + y) % 2 == 0 || board.kind == Board::Kind::chess) continue;
      const int side = static_cast<int>(std::lround(kSide * board.marker_m / board.square_m)), rim = (kSide - side) / 2;
      cv::Mat code;
      cv::aruco::drawMarker(board_dictionary(board.dictionary), marker++, side, code);
      code.copyTo(square(cv::Rect(rim, rim, side, side)));
    }
  }
  if (board.inverted) cv::bitwise_not(image, image);
  return image;
}

/// Seen at a slant, a little blurred, with noise; and where the corners are then.
struct Detected {
  cv::Mat image;
  cv::Matx33d image_from_drawing;

  Vector<2> corner(const Board& board, int id) const {
    const double x = kMargin + kSide * (1 + id % board.corners.width) - 0.5,
                 y = kMargin + kSide * (1 + id / board.corners.width) - 0.5;
    const cv::Vec3d p = image_from_drawing * cv::Vec3d(x, y, 1);
    return {p[0] / p[2], p[1] / p[2]};
  }
};

Detected detected(const Board& board, bool upside_down = false) {
  const cv::Mat flat = drawn(board);
  const double w = flat.cols, h = flat.rows;
  const std::vector<cv::Point2f> from{
      {0, 0}, {static_cast<float>(w), 0}, {static_cast<float>(w), static_cast<float>(h)}, {0, static_cast<float>(h)}};
  std::vector<cv::Point2f> to{{150, 90}, {700, 130}, {640, 560}, {110, 500}};
  if (upside_down) std::rotate(to.begin(), to.begin() + 2, to.end());
  Detected result;
  result.image_from_drawing = cv::Matx33d(cv::getPerspectiveTransform(from, to));
  cv::warpPerspective(flat, result.image, result.image_from_drawing, {800, 640}, cv::INTER_AREA, cv::BORDER_CONSTANT,
                      cv::Scalar(128));
  cv::GaussianBlur(result.image, result.image, {}, 0.8);
  Noise noise(5);
  for (auto it = result.image.begin<unsigned char>(); it != result.image.end<unsigned char>(); ++it)
    *it = cv::saturate_cast<unsigned char>(*it + noise.gaussian(2));
  return result;
}

void expect_found(const Board& board, const Detected& scene, int minimum) {
  const auto view = BoardDetector(board).detect(Image(scene.image));
  ASSERT_TRUE(view) << to_string(board);
  EXPECT_GE(static_cast<int>(view->corners.size()), minimum);
  double square = 0;
  for (const BoardCorner& corner : view->corners) square += (corner.pixel - scene.corner(board, corner.id)).squaredNorm();
  EXPECT_LT(std::sqrt(square / static_cast<double>(view->corners.size())), 0.15) << to_string(board);
}

TEST(BoardDetector, FindsEveryKindToAFractionOfAPixel) {
  for (const char* text :
       {"chess:8x5:0.03", "chess:8x5:0.03:inverted", "charuco:8x6:0.04:0.03:4X4_50", "charuco:7x5:0.04:0.03:5X5_100:inverted"}) {
    const Board board = parse_board(text);
    expect_found(board, detected(board), board.corner_count());
  }
}

TEST(BoardDetector, CornerZeroIsTheSameUpsideDown) {
  for (const char* text : {"chess:8x5:0.03", "charuco:8x6:0.04:0.03:4X4_50"}) {
    const Board board = parse_board(text);
    expect_found(board, detected(board, true), board.corner_count());
  }
}

TEST(BoardDetector, ACharucoOnGlassIsFoundFromBehind) {
  for (const char* text :
       {"charuco:8x6:0.04:0.03:4X4_50", "charuco:7x5:0.04:0.03:5X5_100:inverted", "charuco:4x5:0.05:0.04:4X4_1000"}) {
    const Board board = parse_board(text);
    for (const bool upside_down : {false, true}) {
      Detected scene = detected(board, upside_down);
      cv::flip(scene.image, scene.image, 1);
      scene.image_from_drawing = cv::Matx33d(-1, 0, scene.image.cols - 1, 0, 1, 0, 0, 0, 1) * scene.image_from_drawing;
      expect_found(board, scene, board.corner_count());
      scene.image(cv::Rect(450, 0, 350, 640)).setTo(90);  // a part of it hidden
      expect_found(board, scene, 4);
    }
  }
}

TEST(BoardDetector, AHiddenPartOfACharucoIsLeftOut) {
  const Board board = parse_board("charuco:8x6:0.04:0.03:4X4_50");
  Detected scene = detected(board);
  scene.image(cv::Rect(0, 0, 330, 640)).setTo(90);
  expect_found(board, scene, 6);
  const auto view = BoardDetector(board).detect(Image(scene.image));
  for (const BoardCorner& corner : view->corners) EXPECT_GT(corner.pixel.x(), 325);
}

TEST(BoardDetector, NothingIsFoundWhereThereIsNoSuchBoard) {
  const Detected scene = detected(parse_board("chess:8x5:0.03"));
  EXPECT_FALSE(BoardDetector(parse_board("chess:9x6:0.03")).detect(Image(scene.image)));
  EXPECT_FALSE(BoardDetector(parse_board("charuco:8x6:0.04:0.03:4X4_50")).detect(Image(scene.image)));
  EXPECT_FALSE(BoardDetector(parse_board("chess:9x6:0.03")).detect(Image(cv::Mat(480, 640, CV_8UC1, cv::Scalar(7)))));
  EXPECT_FALSE(BoardDetector(parse_board("chess:9x6:0.03")).detect(Image()));
}

/// A sheet of markers as printed: a marker's black is a whole number of px wide.
cv::Mat sheet(const Board& board, double px_a_metre) {
  const int columns = board.corners.width / 2, rows = board.corners.height / 2,
            side = static_cast<int>(std::lround(board.marker_m * px_a_metre)),
            step = static_cast<int>(std::lround(board.square_m * px_a_metre));
  cv::Mat image((rows - 1) * step + side + 2 * kMargin, (columns - 1) * step + side + 2 * kMargin, CV_8UC1, cv::Scalar(255));
  for (int marker = 0; marker < rows * columns; ++marker) {
    cv::Mat code;
    cv::aruco::drawMarker(board_dictionary(board.dictionary), board.first_marker + marker, side, code);
    code.copyTo(image(cv::Rect(kMargin + marker % columns * step, kMargin + marker / columns * step, side, side)));
  }
  return image;
}

TEST(BoardDetector, MarkersOfASheetAreFoundFromBothSides) {
  for (const char* text : {"aruco:1x1:0.16:0:4X4_50:23", "aruco:3x2:0.06:0.015:5X5_100", "aruco:2x2:0.08:0.02:APRILTAG_36H11:5"}) {
    const Board board = parse_board(text);
    EXPECT_EQ(to_string(board), text);
    const double scale = 240 / (board.square_m * board.corners.width / 2);
    const cv::Mat flat = sheet(board, std::round(board.marker_m * scale / 12) * 12 / board.marker_m);
    const double px_a_metre = std::round(board.marker_m * scale / 12) * 12 / board.marker_m;
    const auto w = static_cast<float>(flat.cols), h = static_cast<float>(flat.rows);
    const std::vector<cv::Point2f> from{{0, 0}, {w, 0}, {w, h}, {0, h}}, to{{200, 140}, {560, 170}, {530, 470}, {180, 430}};
    const cv::Matx33d image_from_sheet(cv::getPerspectiveTransform(from, to));
    cv::Mat image;
    cv::warpPerspective(flat, image, image_from_sheet, {800, 640}, cv::INTER_AREA, cv::BORDER_CONSTANT, cv::Scalar(128));
    cv::GaussianBlur(image, image, {}, 0.8);
    for (const bool behind : {false, true}) {
      cv::Mat shown = image;
      if (behind) cv::flip(image, shown, 1);
      const auto view = BoardDetector(board).detect(Image(shown));
      ASSERT_TRUE(view) << text << behind;
      ASSERT_EQ(static_cast<int>(view->corners.size()), board.corner_count()) << text << behind;
      double squares = 0;
      for (const BoardCorner& corner : view->corners) {
        const Vector<3> at = board.corner(corner.id) * px_a_metre;
        const cv::Vec3d p = image_from_sheet * cv::Vec3d(at.x() + kMargin - 0.5, at.y() + kMargin - 0.5, 1);
        Vector<2> truth(p[0] / p[2], p[1] / p[2]);
        if (behind) truth.x() = shown.cols - 1 - truth.x();
        squares += (corner.pixel - truth).squaredNorm();
      }
      EXPECT_LT(std::sqrt(squares / board.corner_count()), 0.25) << text << behind;
    }
  }
}

}  // namespace
}  // namespace marey::calibrate::board
