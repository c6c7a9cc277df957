#include "marey/calibrate/board/board.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::calibrate::board {
namespace {

TEST(Board, AChessBoardIsRead) {
  const Board board = parse_board("chess:9x6:0.025");
  EXPECT_EQ(board.kind, Board::Kind::chess);
  EXPECT_EQ(board.corners, cv::Size(9, 6));
  EXPECT_EQ(board.corner_count(), 54);
  EXPECT_FALSE(board.inverted);
  EXPECT_TRUE(board.corner(10).isApprox(Vector<3>(0.025, 0.025, 0)));
}

TEST(Board, ACharucoBoardCountsSquaresAndHasCornersWithin) {
  const Board board = parse_board("charuco:4x5:0.054:0.0405:DICT_4x4_1000:inverted");
  EXPECT_EQ(board.kind, Board::Kind::charuco);
  EXPECT_EQ(board.corners, cv::Size(3, 4));
  EXPECT_EQ(board.dictionary, "4X4_1000");
  EXPECT_DOUBLE_EQ(board.marker_m, 0.0405);
  EXPECT_TRUE(board.inverted);
}

TEST(Board, ASheetOfMarkersHasTheirCorners) {
  const Board board = parse_board("aruco:3x2:0.06:0.015:5X5_100:7");
  EXPECT_EQ(board.kind, Board::Kind::aruco);
  EXPECT_EQ(board.corner_count(), 24);
  EXPECT_EQ(board.first_marker, 7);
  EXPECT_TRUE(board.corner(0).isApprox(Vector<3>(0, 0, 0)));
  EXPECT_TRUE(board.corner(3).isApprox(Vector<3>(0.135, 0, 0))) << "the second marker's right side";
  EXPECT_TRUE(board.corner(12).isApprox(Vector<3>(0, 0.075, 0))) << "the second row of markers begins";
}

TEST(Board, ReadsWhatItWrites) {
  for (const char* text : {"chess:9x6:0.025", "charuco:5x7:0.04:0.03:6X6_250", "chess:9x5:0.1:inverted",
                           "aruco:1x1:0.16:0:4X4_50:23", "aruco:3x2:0.06:0.015:5X5_100", "aruco:2x2:0.05:0.01:6X6_50:inverted"})
    EXPECT_EQ(to_string(parse_board(text)), text);
}

TEST(Board, RejectsNonBoardWithReason) {
  const auto why = [](const std::string& text) -> std::string {
    try {
      parse_board(text);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(why("").find("not a kind of board"), std::string::npos);
  EXPECT_NE(why("chess").find("a grid and the side"), std::string::npos);
  EXPECT_NE(why("chess:9:0.025").find("not a grid such as"), std::string::npos);
  EXPECT_NE(why("chess:2x6:0.025").find("must be 3 to 100"), std::string::npos);
  EXPECT_NE(why("chess:9x6:0").find("above 0"), std::string::npos);
  EXPECT_NE(why("chess:9x6:nan").find("above 0"), std::string::npos);
  EXPECT_NE(why("chess:9x6:2.5cm").find("not a side of a square"), std::string::npos);
  EXPECT_NE(why("charuco:4x5:0.05:0.06:4X4_50").find("smaller than its square"), std::string::npos);
  EXPECT_NE(why("charuco:4x5:0.05:0.04:9X9_50").find("no dictionary"), std::string::npos);
  EXPECT_NE(why("aruco:1x1:0.1:0:4X4_50:50").find("needs 51"), std::string::npos);
  EXPECT_NE(why("aruco:2x1:0.1:0:4X4_50").find("white gap"), std::string::npos);
  EXPECT_NE(why("aruco:2x1:0.1:4X4_50").find("sheet of ArUco markers has"), std::string::npos);
  EXPECT_NE(why("charuco:20x20:0.05:0.04:4X4_50").find("needs 200"), std::string::npos);
}

}  // namespace
}  // namespace marey::calibrate::board
