#include "marey/calibrate/board/missing_board.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/calibrate/board/board_detector.h"
#include "marey/calibrate/board/board_dictionary.h"

namespace marey::calibrate::board {
namespace {

/// A board as printed, squares of 60 px, on white.
cv::Mat printed(const Board& board, int first = 0) {
  constexpr int kSquare = 60, kWhite = 50;
  const int columns = board.corners.width + 1, rows = board.corners.height + 1;
  cv::Mat image(rows * kSquare + 2 * kWhite, columns * kSquare + 2 * kWhite, CV_8UC1, cv::Scalar(255));
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      cv::Mat square = image(cv::Rect(kWhite + x * kSquare, kWhite + y * kSquare, kSquare, kSquare));
      if ((x + y) % 2 == 0) square.setTo(0);
      if ((x + y) % 2 == 0 || board.kind == Board::Kind::chess) continue;
      cv::Mat code;
      cv::aruco::drawMarker(board_dictionary(board.dictionary), first++, 45, code);
      code.copyTo(square(cv::Rect(7, 7, 45, 45)));
    }
  }
  return image;
}

/// The board in a grey room of 1280 × 960 px, this much smaller, at a slant.
Image board_image(const Board& board, double scale = 1, double blur = 0.7, int first = 0) {
  const cv::Mat flat = printed(board, first);
  const auto w = static_cast<float>(flat.cols), h = static_cast<float>(flat.rows);
  const auto s = static_cast<float>(scale);
  const std::vector<cv::Point2f> from{{0, 0}, {w, 0}, {w, h}, {0, h}};
  const std::vector<cv::Point2f> to{{300, 200},
                                    {300 + s * w, 200 + 0.06F * s * w},
                                    {300 + 0.94F * s * w, 200 + 0.95F * s * h},
                                    {300 + 0.04F * s * w, 200 + s * h}};
  cv::Mat image;
  cv::warpPerspective(flat, image, cv::getPerspectiveTransform(from, to), {1280, 960}, cv::INTER_AREA, cv::BORDER_CONSTANT,
                      cv::Scalar(120));
  cv::GaussianBlur(image, image, {}, blur);
  return Image(image);
}

/// Of a board that is searched for and is not there.
std::string reason(const std::string& searched, const Image& image) {
  const Board board = parse_board(searched);
  EXPECT_FALSE(BoardDetector(board).detect(image)) << searched;
  return why_missing(board, std::vector<Image>{image});
}

const std::string kNamedBoard = "charuco:7x5:0.04:0.03:5X5_100";

TEST(MissingBoard, TheDictionaryThatFitsIsNamed) {
  for (const std::string dictionary : {"5X5_100", "6X6_50", "7X7_50", "APRILTAG_36H11", "ARUCO_ORIGINAL"}) {
    const std::string right = "charuco:7x5:0.04:0.03:" + dictionary;
    const std::string told = reason("charuco:7x5:0.04:0.03:4X4_50", board_image(parse_board(right)));
    EXPECT_NE(told.find("another dictionary"), std::string::npos) << told;
    EXPECT_NE(told.find("charuco:7x5:0.04:0.03:" + dictionary.substr(0, dictionary.rfind('_') + 1)), std::string::npos) << told;
  }
}

TEST(MissingBoard, ExchangedColoursAndOtherGridsAreNamed) {
  cv::Mat negative;
  cv::bitwise_not(board_image(parse_board(kNamedBoard)).luma(), negative);
  EXPECT_EQ(reason(kNamedBoard, Image(negative)), "black and white are exchanged; give " + kNamedBoard + ":inverted");
  EXPECT_EQ(reason("chess:9x6:0.03", board_image(parse_board("chess:8x5:0.03"))),
            "a chessboard of 8x5 inner corners is detected; give chess:8x5:0.03");
  EXPECT_EQ(reason(kNamedBoard, board_image(parse_board("chess:8x6:0.04"))),
            "a chessboard of 8x6 inner corners is detected; give chess:8x6:0.04");
  const std::string later = reason("charuco:7x5:0.04:0.03:5X5_100", board_image(parse_board(kNamedBoard), 1, 0.7, 60));
  EXPECT_NE(later.find("up to number 76 are detected, and the board as given has 17"), std::string::npos) << later;
}

TEST(MissingBoard, NamesDefectsOfImages) {
  const Board board = parse_board(kNamedBoard);
  const std::string small = reason(kNamedBoard, board_image(board, 0.22, 0.5));
  EXPECT_NE(small.find("px"), std::string::npos) << small;
  EXPECT_NE(small.find("nearer"), std::string::npos) << small;
  const std::string blurred = reason(kNamedBoard, board_image(board, 1, 14));
  EXPECT_NE(blurred.find("blurred"), std::string::npos) << blurred;
  const std::string dark = reason(kNamedBoard, Image(cv::Mat(board_image(board).luma() * 0.02)));
  EXPECT_NE(dark.find("dark"), std::string::npos) << dark;
  cv::Mat room(480, 640, CV_8UC1, cv::Scalar(90));
  cv::rectangle(room, {100, 100, 200, 150}, cv::Scalar(200), cv::FILLED);
  EXPECT_NE(reason(kNamedBoard, Image(room)).find("nothing like it is detected"), std::string::npos);
  EXPECT_NE(why_missing(board, {}).find("too small"), std::string::npos);
}

}  // namespace
}  // namespace marey::calibrate::board
