// Boards in images: OpenCV finds the squares and reads the markers, then every corner is refined.
//
// A ChArUco corner's place is foretold from the markers around it: a homography of the board to the image, fitted to all markers
// but weighing near ones most, because a lens bends straight lines over the width of a board and barely over two squares. The
// foretold place is refined on the image, and omitted where no corner is near it (a hand, glare, the image's edge). Boards
// drawn by OpenCV before 4.7 and after it differ where the number of rows is even: the markers say which it is.
//
// A chess board whose sides are one even and one odd number appears different upside down, so its corner 0 is always the same one;
// with any other, views are the same but for half a turn, and who compares cameras has to find out.
#include "marey/calibrate/board/board_detector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "marey/calibrate/board/board_dictionary.h"
#include "marey/calibrate/board/refine_corner.h"
#include "marey/geometry/decompositions.h"

namespace marey::calibrate::board {
namespace {

constexpr int kMinCorners = 4;
constexpr int kCertainlyInFront = 6;   // corners, or a quarter of the board's: then it is not searched for from behind
constexpr double kMinLikeness = 0.6;   // of opposite points round a corner that nothing hides
constexpr double kSearchWidth = 1600;  // px: larger images are searched at a smaller scale; corners are refined at full size

cv::Mat grey_of(const Image& image, bool inverted) {
  cv::Mat grey = image.luma();
  if (grey.depth() == CV_16U) {
    double maximum = 0;
    cv::minMaxLoc(grey, nullptr, &maximum);
    grey.convertTo(grey, CV_8U, maximum > 0 ? 255.0 / maximum : 1.0);  // 10- and 12-bit sensors leave the upper bits empty
  }
  if (!inverted) return grey;
  cv::Mat negative;
  cv::bitwise_not(grey, negative);
  return negative;
}

/// Mean of the 3 × 3 pixels around a place; the nearest ones where it lies outside.
double brightness(const cv::Mat& grey, const cv::Point2f& at) {
  const int x = std::clamp(static_cast<int>(std::lround(at.x)), 1, grey.cols - 2);
  const int y = std::clamp(static_cast<int>(std::lround(at.y)), 1, grey.rows - 2);
  return cv::mean(grey(cv::Rect(x - 1, y - 1, 3, 3)))[0];
}

/// Corners in the order of Board::corner, whatever order they were found in: right-handed seen from the front, and the square
/// between corner 0 and its three neighbours dark, if the board distinguishes its ends.
void put_in_order(const cv::Mat& grey, const Board& board, std::vector<cv::Point2f>& found) {
  const int columns = board.corners.width, rows = board.corners.height;
  const auto at = [&](int x, int y) -> cv::Point2f& { return found[static_cast<std::size_t>(y * columns + x)]; };
  const cv::Point2f along = at(columns - 1, 0) - at(0, 0), down = at(0, rows - 1) - at(0, 0);
  if (along.cross(down) < 0) {
    for (int y = 0; y < rows; ++y) std::reverse(&at(0, y), &at(0, y) + columns);
  }
  if ((columns + rows) % 2 == 0) return;
  double difference = 0;  // of the two colours, over the whole board
  for (int y = 0; y + 1 < rows; ++y) {
    for (int x = 0; x + 1 < columns; ++x) {
      const double value = brightness(grey, (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1)) / 4);
      difference += (x + y) % 2 == 0 ? value : -value;
    }
  }
  if (difference > 0) std::ranges::reverse(found);
}

/// Distance to the nearest neighbour in the grid, px.
double spacing_at(const std::vector<cv::Point2f>& grid, const cv::Size& size, int id) {
  const int x = id % size.width, y = id / size.width;
  double nearest = 1e9;
  for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
    if (x + dx < 0 || y + dy < 0 || x + dx >= size.width || y + dy >= size.height) continue;
    const cv::Point2f step = grid[static_cast<std::size_t>((y + dy) * size.width + x + dx)] - grid[static_cast<std::size_t>(id)];
    nearest = std::min(nearest, static_cast<double>(std::hypot(step.x, step.y)));
  }
  return nearest;
}

/// Where in the squares' grid a marker lies: its top left corner is (column + margin, row + margin) squares from the outer corner.
struct MarkerPosition {
  int id = 0;
  int column = 0, row = 0;
};

/// `white_first`: the board's first square is white and has marker 0 (OpenCV before 4.7, an even number of rows).
std::vector<MarkerPosition> marker_positions(const cv::Size& squares, bool white_first) {
  std::vector<MarkerPosition> locations;
  for (int row = 0; row < squares.height; ++row) {
    for (int column = 0; column < squares.width; ++column) {
      if ((row + column) % 2 == (white_first ? 0 : 1)) locations.push_back({static_cast<int>(locations.size()), column, row});
    }
  }
  return locations;
}

struct MarkerPoints {
  std::vector<cv::Point2f> board;  // in squares, from corner 0
  std::vector<cv::Point2f> image;
};

/// The homography that fits the points, those near `centre` (in squares) most.
cv::Matx33d homography_near(const MarkerPoints& points, const std::vector<unsigned char>& good, const cv::Point2f& centre) {
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  cv::Point2f origin;
  for (const cv::Point2f& p : points.image) origin += p / static_cast<float>(points.image.size());
  double scale = 0;
  for (const cv::Point2f& p : points.image) scale += cv::norm(p - origin) / static_cast<double>(points.image.size());
  for (std::size_t i = 0; i < points.board.size(); ++i) {
    if (!good[i]) continue;
    const cv::Point2f b = points.board[i] - centre, p = (points.image[i] - origin) / scale;
    const double weight = 1 / (0.5 + b.dot(b));
    const Eigen::Matrix<double, 9, 1> u{b.x, b.y, 1, 0, 0, 0, -p.x * b.x, -p.x * b.y, -p.x};
    const Eigen::Matrix<double, 9, 1> v{0, 0, 0, b.x, b.y, 1, -p.y * b.x, -p.y * b.y, -p.y};
    normal += weight * weight * (u * u.transpose() + v * v.transpose());
  }
  const geometry::Eigenpairs<9> solver = geometry::eigenpairs<9>(normal);
  const Eigen::Matrix<double, 9, 1> h = solver.vectors.col(0);
  const cv::Matx33d back(scale, 0, origin.x, 0, scale, origin.y, 0, 0, 1);
  return back * cv::Matx33d(h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], h[8]) *
         cv::Matx33d(1, 0, -centre.x, 0, 1, -centre.y, 0, 0, 1);
}

cv::Point2f mapped(const cv::Matx33d& h, double x, double y) {
  const cv::Vec3d p = h * cv::Vec3d(x, y, 1);
  return {static_cast<float>(p[0] / p[2]), static_cast<float>(p[1] / p[2])};
}

}  // namespace

struct BoardDetector::Markers {
  cv::Ptr<cv::aruco::Dictionary> dictionary;
  cv::Ptr<cv::aruco::DetectorParameters> parameters = cv::aruco::DetectorParameters::create();
  std::vector<std::vector<MarkerPosition>> layouts;  // as the board may have been drawn
};

BoardDetector::BoardDetector(const Board& board) : board_(board), markers_(std::make_unique<Markers>()) {
  if (board_.kind == Board::Kind::chess) return;
  if (board_.kind == Board::Kind::aruco) {
    markers_->dictionary = board_dictionary(board_.dictionary);
    return;
  }
  const cv::Size squares(board_.corners.width + 1, board_.corners.height + 1);
  markers_->dictionary = board_dictionary(board_.dictionary);
  markers_->parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
  markers_->layouts.push_back(marker_positions(squares, false));
  if (squares.height % 2 == 0) markers_->layouts.push_back(marker_positions(squares, true));
}

BoardDetector::~BoardDetector() = default;

std::optional<BoardView> BoardDetector::detect(const Image& image) const {
  if (image.empty() || std::min(image.size().width, image.size().height) < 16) return std::nullopt;
  const cv::Mat grey = grey_of(image, board_.inverted);
  return board_.kind == Board::Kind::chess ? chess(grey) : from_either_side(grey);
}

std::optional<BoardView> BoardDetector::chess(const cv::Mat& grey) const {
  const double factor = std::min(1.0, kSearchWidth / std::max(grey.cols, grey.rows));
  cv::Mat small = grey;
  if (factor < 1) cv::resize(grey, small, {}, factor, factor, cv::INTER_AREA);
  std::vector<cv::Point2f> found;
  const int typical = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE;
  if (!cv::checkChessboard(small, board_.corners)) return std::nullopt;
  if (!cv::findChessboardCorners(small, board_.corners, found, typical) &&
      !cv::findChessboardCornersSB(small, board_.corners, found, cv::CALIB_CB_NORMALIZE_IMAGE))
    return std::nullopt;
  if (static_cast<int>(found.size()) != board_.corner_count()) return std::nullopt;
  for (cv::Point2f& p : found) {
    const double shift = 0.5 / factor - 0.5;  // pixel centres are integers at both scales
    p = {static_cast<float>(p.x / factor + shift), static_cast<float>(p.y / factor + shift)};
  }
  put_in_order(grey, board_, found);
  BoardView view;
  for (int id = 0; id < board_.corner_count(); ++id) {
    const cv::Point2f start = found[static_cast<std::size_t>(id)];
    const auto pixel = refine_corner(grey, {start.x, start.y}, spacing_at(found, board_.corners, id));
    if (!pixel) return std::nullopt;
    view.corners.push_back({id, *pixel});
  }
  return view;
}

/// The side from which more of the board is seen: a mirrored marker may now and then be read as another one.
std::optional<BoardView> BoardDetector::from_either_side(const cv::Mat& grey) const {
  const auto seen_in = [&](const cv::Mat& image) { return board_.kind == Board::Kind::aruco ? aruco(image) : charuco(image); };
  auto front = seen_in(grey);
  if (front && static_cast<int>(front->corners.size()) >= std::max(kCertainlyInFront, board_.corner_count() / 4)) return front;
  cv::Mat mirrored;
  cv::flip(grey, mirrored, 1);
  auto behind = seen_in(mirrored);
  if (!behind || (front && front->corners.size() >= behind->corners.size())) return front;
  for (BoardCorner& corner : behind->corners) corner.pixel.x() = grey.cols - 1 - corner.pixel.x();
  return behind;
}

/// Every corner of a marker is where two edges of its black square meet. What lies in the first cell within is inspected alone.
std::optional<BoardView> BoardDetector::aruco(const cv::Mat& grey) const {
  std::vector<std::vector<cv::Point2f>> quads;
  std::vector<int> ids;
  cv::aruco::detectMarkers(grey, markers_->dictionary, quads, ids, markers_->parameters);
  const int columns = board_.corners.width / 2, markers = columns * board_.corners.height / 2;
  BoardView view;
  std::vector<cv::Point2f> on_board, in_image;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const int marker = ids[i] - board_.first_marker;
    if (marker < 0 || marker >= markers || std::ranges::count(ids, ids[i]) > 1) continue;
    const double cell = std::sqrt(std::abs(cv::contourArea(quads[i]))) / (markers_->dictionary->markerSize + 2);
    const int window = std::clamp(static_cast<int>(0.7 * cell), 2, 12);
    cv::cornerSubPix(grey, quads[i], {window, window}, {-1, -1}, {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 50, 1e-3});
    for (int k = 0; k < 4; ++k) {  // clockwise from the top left
      const int column = 2 * (marker % columns) + (k == 1 || k == 2 ? 1 : 0), row = 2 * (marker / columns) + (k >= 2 ? 1 : 0);
      const int id = row * board_.corners.width + column;
      const cv::Point2f& pixel = quads[i][static_cast<std::size_t>(k)];
      view.corners.push_back({id, {pixel.x, pixel.y}});
      const Vector<3> location = board_.corner(id);
      on_board.emplace_back(static_cast<float>(location.x()), static_cast<float>(location.y()));
      in_image.push_back(pixel);
    }
  }
  if (static_cast<int>(view.corners.size()) < kMinCorners) return std::nullopt;
  if (view.corners.size() > kMinCorners) {  // a marker that lies elsewhere, or was misread
    std::vector<unsigned char> good;
    const double width = std::max(4.0, 0.02 * grey.cols);
    if (cv::findHomography(on_board, in_image, good, cv::RANSAC, width).empty()) return std::nullopt;
    std::size_t i = 0;
    std::erase_if(view.corners, [&](const BoardCorner&) { return good[i++] == 0; });
  }
  std::ranges::sort(view.corners, {}, &BoardCorner::id);
  return static_cast<int>(view.corners.size()) < kMinCorners ? std::nullopt : std::optional(std::move(view));
}

std::optional<BoardView> BoardDetector::charuco(const cv::Mat& grey) const {
  std::vector<std::vector<cv::Point2f>> quads;
  std::vector<int> ids;
  cv::aruco::detectMarkers(grey, markers_->dictionary, quads, ids, markers_->parameters);
  const double margin = 0.5 * (1 - board_.marker_m / board_.square_m);
  MarkerPoints points;
  std::vector<unsigned char> good;
  int maximum = 0;
  for (const std::vector<MarkerPosition>& layout : markers_->layouts) {
    MarkerPoints tried;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (ids[i] >= static_cast<int>(layout.size())) continue;
      const MarkerPosition& location = layout[static_cast<std::size_t>(ids[i])];
      for (int k = 0; k < 4; ++k) {  // clockwise from the top left
        const double x = location.column - 1 + (k == 1 || k == 2 ? 1 - margin : margin);
        const double y = location.row - 1 + (k >= 2 ? 1 - margin : margin);
        tried.board.emplace_back(static_cast<float>(x), static_cast<float>(y));
        tried.image.push_back(quads[i][static_cast<std::size_t>(k)]);
      }
    }
    if (tried.board.size() < 4) continue;
    double side = 0;  // of a marker, px: what the homography may miss by bending, in proportion
    for (std::size_t i = 0; i < tried.image.size(); i += 4) side = std::max(side, cv::norm(tried.image[i] - tried.image[i + 1]));
    std::vector<unsigned char> inliers;
    if (cv::findHomography(tried.board, tried.image, inliers, cv::RANSAC, std::max(2.0, 0.15 * side)).empty()) continue;
    const int count = cv::countNonZero(inliers);
    if (count <= maximum) continue;
    maximum = count;
    points = std::move(tried);
    good = std::move(inliers);
  }
  if (maximum < 4) return std::nullopt;
  BoardView view;
  for (int id = 0; id < board_.corner_count(); ++id) {
    const cv::Point2f location(static_cast<float>(id % board_.corners.width), static_cast<float>(id / board_.corners.width));
    const bool near = std::ranges::any_of(points.board, [&](const cv::Point2f& p) { return cv::norm(p - location) < 1; });
    if (!near) continue;
    const cv::Matx33d h = homography_near(points, good, location);
    const cv::Point2f start = mapped(h, location.x, location.y);
    double spacing = 1e9;
    for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}})
      spacing = std::min(spacing, cv::norm(mapped(h, location.x + dx, location.y + dy) - start));
    const double reach = 0.5 * (board_.square_m - board_.marker_m) / board_.square_m;  // up to the markers' black
    const auto pixel = refine_corner(grey, {start.x, start.y}, spacing * std::min(1.0, 2 * std::numbers::sqrt2 * reach + 0.35));
    if (pixel && opposite_likeness(grey, *pixel, 0.25 * spacing) > kMinLikeness) view.corners.push_back({id, *pixel});
  }
  if (static_cast<int>(view.corners.size()) < kMinCorners) return std::nullopt;
  return view;
}

}  // namespace marey::calibrate::board
