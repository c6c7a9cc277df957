#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/core/geometry.h"

namespace marey::calibrate::board {

/// A flat calibration board. Its corners are the places where four squares meet, or the corners of a sheet's markers: they lie in
/// the plane z = 0 of the board's frame, corner 0 at the origin, numbered along x first; x runs along a row, y from row to row, and
/// z away from the viewer.
struct Board {
  enum class Kind { chess, charuco, aruco };

  Kind kind = Kind::chess;
  cv::Size corners;        ///< how many in a row, and how many rows; at least 2 of each
  double square_m = 0;     ///< side of a square; aruco: from one marker's beginning to the next one's
  double marker_m = 0;     ///< side of a marker, where there are some
  std::string dictionary;  ///< of its markers, "4X4_50", …
  int first_marker = 0;    ///< aruco: number of the marker at the top left; the others follow along the rows
  bool inverted = false;   ///< black and white are exchanged

  int corner_count() const { return corners.width * corners.height; }
  /// Where corner `id` lies in the board's frame, m.
  Vector<3> corner(int id) const {
    const int row = id / corners.width, column = id % corners.width;
    if (kind != Kind::aruco) return {column * square_m, row * square_m, 0.0};
    return {column / 2 * square_m + column % 2 * marker_m, row / 2 * square_m + row % 2 * marker_m, 0.0};
  }
};

/// `chess:9x6:0.025` (inner corners, side of a square in m), `charuco:COLSxROWS:SQUARE:MARKER:DICTIONARY` (squares, sides in m, a
/// dictionary of OpenCV's such as 4X4_50) or `aruco:COLSxROWS:MARKER:GAP:DICTIONARY[:FIRST]` (markers, side and gap in m); with
/// `:inverted` behind it. Throws Error, one sentence, where it is neither.
Board parse_board(const std::string& text);

/// The names of dictionaries that parse_board takes.
std::vector<std::string> board_dictionaries();

/// As parse_board reads it.
std::string to_string(const Board& board);

}  // namespace marey::calibrate::board
