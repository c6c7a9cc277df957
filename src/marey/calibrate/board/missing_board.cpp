// The first of these that the images show: markers of the board's dictionary, upright or inverted; markers of another
// one, for which the one with the most in any image is taken, the smallest of its family that has them all; a chess board of
// another grid; squares in which no marker can be read. The rest is the state of the images: dark, or smeared.
#include "marey/calibrate/board/missing_board.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "marey/calibrate/board/board_detector.h"
#include "marey/calibrate/board/board_dictionary.h"
#include "marey/geometry/median.h"

namespace marey::calibrate::board {
namespace {

// numerical: bounds the cost.
constexpr std::size_t kMaxImages = 12;
// These choose a sentence and change no measurement, by definition: markers and squares in one image, fewer of which may be
// anything; the brightest hundredth of an image, of 255; an edge's step between two pixels.
constexpr std::size_t kMinMarkers = 3, kMinSquares = 4;
constexpr double kDark = 40, kSmeared = 0.22;
const std::array<cv::Size, 12> kGrids{cv::Size(9, 6), {8, 6}, {7, 5}, {7, 6}, {8, 5},  {8, 7},
                                      {10, 7},        {9, 7}, {6, 4}, {6, 5}, {11, 8}, {5, 4}};

double middle_of(std::vector<double> values) {
  return geometry::median(values);
}

cv::Mat eight_bits(const Image& image) {
  cv::Mat grey = image.luma();
  if (grey.depth() != CV_16U) return grey;
  double maximum = 0;
  cv::minMaxLoc(grey, nullptr, &maximum);
  grey.convertTo(grey, CV_8U, maximum > 0 ? 255.0 / maximum : 1.0);
  return grey;
}

/// What is detected of one dictionary in one image.
struct DetectedMarkers {
  std::vector<int> ids;
  std::vector<double> sides;       // px
  std::vector<double> unreadable;  // sides of squares without a marker that can be read, px
};

DetectedMarkers markers_in(const cv::Mat& grey, const std::string& dictionary) {
  std::vector<std::vector<cv::Point2f>> quads, rejected;
  DetectedMarkers detected;
  cv::aruco::detectMarkers(grey, board_dictionary(dictionary), quads, detected.ids, cv::aruco::DetectorParameters::create(),
                           rejected);
  const auto side_of = [](const std::vector<cv::Point2f>& quad) { return std::sqrt(std::abs(cv::contourArea(quad))); };
  for (const auto& quad : quads) detected.sides.push_back(side_of(quad));
  for (const auto& quad : rejected) detected.unreadable.push_back(side_of(quad));
  return detected;
}

/// The image in which most of them are detected.
DetectedMarkers max_markers(const std::vector<cv::Mat>& images, const std::string& dictionary) {
  DetectedMarkers most;
  for (const cv::Mat& grey : images) {
    DetectedMarkers detected = markers_in(grey, dictionary);
    if (detected.ids.size() > most.ids.size() || (most.ids.empty() && detected.unreadable.size() > most.unreadable.size()))
      most = std::move(detected);
  }
  return most;
}

std::vector<cv::Mat> negatives(const std::vector<cv::Mat>& images) {
  std::vector<cv::Mat> all;
  for (const cv::Mat& grey : images) {
    cv::Mat negative;
    cv::bitwise_not(grey, negative);
    all.push_back(negative);
  }
  return all;
}

int markers_of(const Board& board) {
  if (board.kind == Board::Kind::aruco) return board.first_marker + board.corners.area() / 4;
  return (board.corners.width + 1) * (board.corners.height + 1) / 2;
}

std::string board_in(const Board& board, const std::string& dictionary) {
  Board other = board;
  other.dictionary = dictionary;
  return to_string(other);
}

/// "4X4" of "4X4_50".
std::string family_of(const std::string& dictionary) {
  return dictionary.substr(0, dictionary.rfind('_'));
}

/// Markers of the right dictionary are there, but no board of them.
std::string not_this_grid(const Board& board, const DetectedMarkers& detected) {
  const int largest = *std::ranges::max_element(detected.ids);
  if (largest >= markers_of(board))
    return fmt::format("markers of {} up to number {} are detected, and the board as given has {}: has it more squares?",
                       board.dictionary, largest, markers_of(board));
  return fmt::format(
      "at most {} of its {} markers are seen in an image, {:.0f} px wide: show more of the board, nearer and flatter",
      detected.ids.size(), markers_of(board), middle_of(detected.sides));
}

std::optional<std::string> another_dictionary(const Board& board, const std::vector<cv::Mat>& images) {
  std::string best;
  DetectedMarkers most;
  for (const std::string& name : board_dictionaries()) {
    if (family_of(name) == family_of(board.dictionary) && board_dictionary_size(name) <= board_dictionary_size(board.dictionary))
      continue;
    DetectedMarkers detected = max_markers(images, name);
    if (detected.ids.size() < kMinMarkers || detected.ids.size() <= most.ids.size()) continue;
    most = std::move(detected);
    best = name;
  }
  if (best.empty()) return std::nullopt;
  return fmt::format("its markers are of another dictionary: {} markers of {} are seen in an image; give {}", most.ids.size(), best,
                     board_in(board, best));
}

std::optional<std::string> another_grid(const Board& board, const std::vector<cv::Mat>& images) {
  for (const cv::Mat& grey : images) {
    cv::Mat small = grey;
    if (grey.cols > 800) cv::resize(grey, small, {}, 800.0 / grey.cols, 800.0 / grey.cols, cv::INTER_AREA);
    for (const cv::Size& grid : kGrids) {
      std::vector<cv::Point2f> corners;
      if (grid == board.corners || !cv::checkChessboard(small, grid)) continue;
      if (!cv::findChessboardCornersSB(small, grid, corners, cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE)) continue;
      Board other = board;
      other.kind = Board::Kind::chess;
      other.corners = grid;
      return fmt::format("a chessboard of {}x{} inner corners is detected; give {}", grid.width, grid.height, to_string(other));
    }
  }
  return std::nullopt;
}

/// The steepest step between two pixels beside an image's strongest edges, as a share of their height.
double edge_steepness(const cv::Mat& grey) {
  cv::Mat along, down, size;
  cv::Sobel(grey, along, CV_32F, 1, 0, 1, 0.5);
  cv::Sobel(grey, down, CV_32F, 0, 1, 1, 0.5);
  cv::magnitude(along, down, size);
  constexpr int kRound = 7;  // px round an edge; numerical
  cv::Mat low, high;
  cv::erode(grey, low, cv::Mat::ones(2 * kRound + 1, 2 * kRound + 1, CV_8U));
  cv::dilate(grey, high, cv::Mat::ones(2 * kRound + 1, 2 * kRound + 1, CV_8U));
  std::vector<std::pair<float, float>> edges;  // steepness, height
  for (int y = kRound; y < grey.rows - kRound; y += 2) {
    for (int x = kRound; x < grey.cols - kRound; x += 2)
      edges.emplace_back(size.at<float>(y, x), static_cast<float>(high.at<unsigned char>(y, x) - low.at<unsigned char>(y, x)));
  }
  if (edges.size() < 100) return 1;
  const auto strongest = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 200);
  std::nth_element(edges.begin(), strongest, edges.end(), std::greater<>());
  std::vector<double> shares;
  for (auto edge = edges.begin(); edge != strongest; ++edge) {
    if (edge->second > 20) shares.push_back(edge->first / edge->second);
  }
  return shares.empty() ? 1 : middle_of(shares);
}

double brightest_hundredth(const cv::Mat& grey) {
  std::vector<unsigned char> values;
  for (int y = 0; y < grey.rows; y += 4) {
    for (int x = 0; x < grey.cols; x += 4) values.push_back(grey.at<unsigned char>(y, x));
  }
  if (values.empty()) return 255;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 99 / 100);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

std::string how_the_images_are(const std::vector<cv::Mat>& images) {
  std::vector<double> bright, steep;
  for (const cv::Mat& grey : images) {
    bright.push_back(brightest_hundredth(grey));
    steep.push_back(edge_steepness(grey));
  }
  if (const double value = middle_of(bright); value < kDark)
    return fmt::format("the images are dark, {:.0f} of 255 at the brightest hundredth: more light, or a longer exposure", value);
  if (const double value = *std::ranges::max_element(steep); value < kSmeared)
    return fmt::format(
        "the images are blurred, their sharpest edges smeared over {:.0f} px: hold the board still, expose for a shorter time, "
        "focus",
        1 / value);
  return "nothing like it is detected; are its kind, its numbers and its colours as given?";
}

std::optional<std::string> by_markers(const Board& board, const std::vector<cv::Mat>& images) {
  const DetectedMarkers right = max_markers(images, board.dictionary), negative = max_markers(negatives(images), board.dictionary);
  if (negative.ids.size() >= kMinMarkers && negative.ids.size() > 2 * right.ids.size()) {
    Board other = board;
    other.inverted = !board.inverted;
    return fmt::format("black and white are exchanged; give {}", to_string(other));
  }
  auto other = another_dictionary(board, images);
  if (right.ids.size() >= kMinMarkers || (!right.ids.empty() && !other)) return not_this_grid(board, right);
  if (other) return other;
  std::vector<double> squares;
  for (const double side : right.unreadable) {
    if (side > 4) squares.push_back(side);
  }
  const double least = 2.0 * (board_dictionary(board.dictionary)->markerSize + 2);
  if (squares.size() >= kMinSquares && middle_of(squares) < 1.5 * least)
    return fmt::format(
        "squares of about {:.0f} px are seen in which no marker can be read; a marker of {} needs {:.0f} px: nearer, or more "
        "pixels",
        middle_of(squares), board.dictionary, least);
  return std::nullopt;
}

}  // namespace

std::string why_missing(const Board& board, std::span<const Image> images) {
  std::vector<cv::Mat> greys;
  const std::size_t step = std::max<std::size_t>(1, images.size() / kMaxImages);
  for (std::size_t i = 0; i < images.size() && greys.size() < kMaxImages; i += step) {
    if (std::min(images[i].size().width, images[i].size().height) >= 32) greys.push_back(eight_bits(images[i]));
  }
  if (greys.empty()) return "the images are too small to show anything";
  const std::vector<cv::Mat> shown = board.inverted ? negatives(greys) : greys;
  if (board.kind != Board::Kind::chess) {
    if (auto reason = by_markers(board, shown)) return *reason;
  }
  if (auto reason = another_grid(board, shown)) return *reason;
  return how_the_images_are(greys);
}

}  // namespace marey::calibrate::board
