#include "marey/calibrate/board/board.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/calibrate/board/board_dictionary.h"
#include "marey/core/error.h"

namespace marey::calibrate::board {
namespace {

constexpr int kMaxCorners = 100;  // in a row or a column

std::vector<std::string> split(const std::string& text, char mark) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find(mark, begin)) != std::string::npos; begin = end + 1)
    parts.push_back(text.substr(begin, end - begin));
  parts.push_back(text.substr(begin));
  return parts;
}

template <typename Number>
std::optional<Number> number(const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw Error(
      "board \"{}\": {}; write chess:9x6:0.025 (inner corners, m), charuco:5x7:0.04:0.03:4X4_50 (squares, m) or "
      "aruco:1x1:0.16:0:4X4_50 (markers, their side and the gap, m), :inverted behind it where black and white are exchanged",
      text, why);
}

cv::Size grid_of(const std::string& text, const std::string& part, int minimum) {
  const std::vector<std::string> sides = split(part, 'x');
  const auto width = number<int>(sides[0]);
  const auto height = sides.size() == 2 ? number<int>(sides[1]) : std::nullopt;
  if (!width || !height) refuse(text, fmt::format("\"{}\" is not a grid such as 9x6", part));
  if (std::min(*width, *height) < minimum || std::max(*width, *height) > kMaxCorners)
    refuse(text, fmt::format("a grid of {} is not possible; each side must be {} to {}", part, minimum, kMaxCorners));
  return {*width, *height};
}

double side_of(const std::string& text, const std::string& part, const char* what) {
  const auto side = number<double>(part);
  if (!side) refuse(text, fmt::format("\"{}\" is not a side of a {}", part, what));
  if (!(*side > 0 && *side < 100))
    refuse(text, fmt::format("the side of a {} is {} m; it must be above 0 and below 100", what, part));
  return *side;
}

std::string dictionary_of(const std::string& text, std::string name, int markers) {
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  if (name.starts_with("DICT_")) name.erase(0, 5);
  const auto size = board_dictionary_size(name);
  if (!size) refuse(text, fmt::format("there is no dictionary \"{}\"; supported: {}", name, fmt::join(board_dictionaries(), " ")));
  if (*size < markers) refuse(text, fmt::format("dictionary {} holds {} markers and the board needs {}", name, *size, markers));
  return name;
}

/// What stands behind "aruco".
Board sheet_of(const std::string& text, const std::vector<std::string>& parts) {
  if (parts.size() != 5 && parts.size() != 6)
    refuse(
        text,
        "a sheet of ArUco markers has a grid, the side of a marker, the gap between two, a dictionary, and maybe the first number");
  Board board;
  board.kind = Board::Kind::aruco;
  const cv::Size markers = grid_of(text, parts[1], 1);
  board.corners = {2 * markers.width, 2 * markers.height};
  board.marker_m = side_of(text, parts[2], "marker");
  const auto gap = number<double>(parts[3]);
  if (!gap || !(*gap >= 0 && *gap < 100)) refuse(text, fmt::format("\"{}\" is not a gap in m", parts[3]));
  if (*gap == 0 && markers.area() > 1) refuse(text, "markers need a white gap between them");
  board.square_m = board.marker_m + *gap;
  if (parts.size() == 6) {
    const auto first = number<int>(parts[5]);
    if (!first || *first < 0 || *first > 100'000) refuse(text, fmt::format("\"{}\" is not the number of a marker", parts[5]));
    board.first_marker = *first;
  }
  board.dictionary = dictionary_of(text, parts[4], board.first_marker + markers.area());
  return board;
}

}  // namespace

Board parse_board(const std::string& text) {
  std::vector<std::string> parts = split(text, ':');
  Board board;
  if (parts.size() > 1 && parts.back() == "inverted") {
    board.inverted = true;
    parts.pop_back();
  }
  if (parts[0] == "chess") {
    if (parts.size() != 3) refuse(text, "a chess board has a grid and the side of a square");
    board.corners = grid_of(text, parts[1], 3);
    board.square_m = side_of(text, parts[2], "square");
    return board;
  }
  if (parts[0] == "aruco") {
    const bool inverted = board.inverted;
    board = sheet_of(text, parts);
    board.inverted = inverted;
    return board;
  }
  if (parts[0] != "charuco") refuse(text, fmt::format("\"{}\" is not a kind of board", parts[0]));
  if (parts.size() != 5) refuse(text, "a ChArUco board has a grid, the sides of a square and of a marker, and a dictionary");
  const cv::Size squares = grid_of(text, parts[1], 3);
  board.kind = Board::Kind::charuco;
  board.corners = {squares.width - 1, squares.height - 1};
  board.square_m = side_of(text, parts[2], "square");
  board.marker_m = side_of(text, parts[3], "marker");
  if (board.marker_m >= board.square_m) refuse(text, "a marker must be smaller than its square");
  board.dictionary = dictionary_of(text, parts[4], squares.area() / 2);
  return board;
}

std::string to_string(const Board& board) {
  const char* inverted = board.inverted ? ":inverted" : "";
  if (board.kind == Board::Kind::chess)
    return fmt::format("chess:{}x{}:{}{}", board.corners.width, board.corners.height, board.square_m, inverted);
  if (board.kind == Board::Kind::aruco) {
    return fmt::format("aruco:{}x{}:{}:{:g}:{}{}{}", board.corners.width / 2, board.corners.height / 2, board.marker_m,
                       board.square_m - board.marker_m, board.dictionary,
                       board.first_marker > 0 ? fmt::format(":{}", board.first_marker) : "", inverted);
  }
  return fmt::format("charuco:{}x{}:{}:{}:{}{}", board.corners.width + 1, board.corners.height + 1, board.square_m, board.marker_m,
                     board.dictionary, inverted);
}

}  // namespace marey::calibrate::board
