// The level curve is that of marching squares: each cell between four samples holds the piece of the curve that its corners give,
// directed so that what is covered lies at its right hand; pieces are then followed from edge to edge. Where two corners across are
// covered and two are not, the covered ones are kept apart.
#include "marey/track/contour/colour/colour_patch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "marey/geometry/bspline.h"
#include "marey/track/contour/line_search.h"

namespace marey::track::contour::colour {
namespace {

cv::Mat in_cells(const cv::Mat& plane, const cv::Size& cells) {
  cv::Mat scaled, result;
  if (plane.size() == cells) {
    scaled = plane;
  } else {
    cv::resize(plane, scaled, cells, 0, 0, plane.cols > cells.width ? cv::INTER_AREA : cv::INTER_LINEAR);
  }
  scaled.convertTo(result, CV_32F);
  return result;
}

/// A plane moved to the left by this many cells.
cv::Mat moved_left(const cv::Mat& plane, double by) {
  constexpr double kLittle = 0.05;  // cells; numerical: less costs a resampling and moves no edge
  if (std::abs(by) < kLittle) return plane;
  const int whole = static_cast<int>(std::floor(by)), last = plane.cols - 1;
  const auto part = static_cast<float>(by - whole);
  cv::Mat moved(plane.size(), CV_32FC1);
  for (int y = 0; y < plane.rows; ++y) {
    const float* from = plane.ptr<float>(y);
    float* to = moved.ptr<float>(y);
    const auto at = [&](int x) { return from[std::clamp(x, 0, last)]; };
    for (int x = 0; x <= last; ++x) to[x] = at(x + whole) + part * (at(x + whole + 1) - at(x + whole));
  }
  return moved;
}

enum Edge { top, right, bottom, left, none };
struct Piece {
  Edge from, to;
};
/// By corners covered: 1 top left, 2 top right, 4 bottom right, 8 bottom left.
constexpr std::array<std::array<Piece, 2>, 16> kPieces{{
    {{{none, none}, {none, none}}},
    {{{top, left}, {none, none}}},
    {{{right, top}, {none, none}}},
    {{{right, left}, {none, none}}},
    {{{bottom, right}, {none, none}}},
    {{{top, left}, {bottom, right}}},
    {{{bottom, top}, {none, none}}},
    {{{bottom, left}, {none, none}}},
    {{{left, bottom}, {none, none}}},
    {{{top, bottom}, {none, none}}},
    {{{right, top}, {left, bottom}}},
    {{{right, bottom}, {none, none}}},
    {{{left, right}, {none, none}}},
    {{{top, right}, {none, none}}},
    {{{left, top}, {none, none}}},
    {{{none, none}, {none, none}}},
}};

/// The pieces of the curve as links from edge to edge; edge 2i runs right from sample i, edge 2i + 1 down.
class LevelCurves {
 public:
  explicit LevelCurves(const cv::Mat& fraction) {
    cv::copyMakeBorder(fraction, values_, 1, 1, 1, 1, cv::BORDER_CONSTANT, 0);
    next_.assign(2 * values_.total(), -1);
    for (int y = 0; y + 1 < values_.rows; ++y) {
      const float* upper = values_.ptr<float>(y);
      const float* lower = values_.ptr<float>(y + 1);
      for (int x = 0; x + 1 < values_.cols; ++x) {
        const int corners = (upper[x] >= 0.5F ? 1 : 0) | (upper[x + 1] >= 0.5F ? 2 : 0) | (lower[x + 1] >= 0.5F ? 4 : 0) |
                            (lower[x] >= 0.5F ? 8 : 0);
        for (const Piece& piece : kPieces[static_cast<std::size_t>(corners)]) {
          if (piece.from != none) next_[edge(x, y, piece.from)] = static_cast<int>(edge(x, y, piece.to));
        }
      }
    }
  }

  /// In cells of the mask given; each curve once.
  template <typename Visit>
  void for_each(const Visit& visit) {
    std::vector<Vector<2>> curve;
    for (std::size_t begin = 0; begin < next_.size(); ++begin) {
      if (next_[begin] < 0) continue;
      curve.clear();
      int at = static_cast<int>(begin);
      while (at >= 0 && next_[at] >= 0) {
        curve.push_back(location(at));
        const int after = next_[at];
        next_[at] = -1;
        at = after;
      }
      visit(curve);
    }
  }

 private:
  std::size_t edge(int x, int y, Edge which) const {
    if (which == bottom) ++y;
    if (which == right) ++x;
    return 2 * (static_cast<std::size_t>(y) * values_.cols + x) + (which == left || which == right ? 1 : 0);
  }
  Vector<2> location(int edge) const {
    const int sample = edge / 2, x = sample % values_.cols, y = sample / values_.cols;
    const bool down = edge % 2 != 0;
    const float here = values_.at<float>(y, x), there = down ? values_.at<float>(y + 1, x) : values_.at<float>(y, x + 1);
    const double part = std::clamp((0.5 - here) / (there - here), 0.0, 1.0);
    return {x - 1 + (down ? 0 : part), y - 1 + (down ? part : 0)};
  }

  cv::Mat values_;
  std::vector<int> next_;
};

}  // namespace

int cell_step(double height) {
  return height <= 100 ? 1 : height <= 220 ? 2 : 4;
}

ColourPatch cut_patch(const Image& image, const cv::Mat& mask, const Box& box, int step, const SceneImage* scene) {
  const int unit = std::max(2, step);
  const auto down = [&](double value) { return static_cast<int>(std::floor(value / unit)) * unit; };
  const cv::Rect all({0, 0}, cv::Size(image.size().width / unit * unit, image.size().height / unit * unit));
  const cv::Point from(down(box.left), down(box.top));
  const cv::Point to(down(box.right()) + unit, down(box.bottom()) + unit);
  const cv::Rect area = cv::Rect(from, to) & all;
  ColourPatch patch;
  patch.step = step;
  patch.corner = area.tl();
  if (area.empty() || image.luma().type() != CV_8UC1) return patch;
  const cv::Size cells(area.width / step, area.height / step);
  std::array<cv::Mat, 3> planes{in_cells(image.luma()(area), cells), {}, {}};
  const cv::Rect half(area.x / 2, area.y / 2, area.width / 2, area.height / 2);
  const double shift = scene != nullptr ? scene->chroma_shift() / step : 0;
  for (int i = 1; i < 3; ++i) {
    planes[i] = image.is_colour() ? moved_left(in_cells((i == 1 ? image.cb() : image.cr())(half), cells), shift)
                                  : cv::Mat(cells, CV_32FC1, cv::Scalar(128));
  }
  cv::merge(planes.data(), planes.size(), patch.colour);
  patch.mask = in_cells(mask(area), cells) / 255;
  if (scene != nullptr && scene->has(image.size())) {
    std::array<cv::Mat, 3> empty{in_cells(scene->luma(area), cells), {}, {}};
    for (int i = 1; i < 3; ++i) empty[i] = moved_left(in_cells(scene->chroma(i - 1, half), cells), shift);
    cv::merge(empty.data(), empty.size(), patch.scene);
    patch.known = in_cells(scene->known(area), cells);
  }
  return patch;
}

cv::Mat cells_within(std::span<const Vector<2>> polygon, const ColourPatch& patch) {
  std::vector<Vector<2>> corners;
  corners.reserve(polygon.size());
  for (const Vector<2>& corner : polygon) corners.push_back(patch.cell(corner));
  Footprint footprint;
  footprint.fill(corners);
  cv::Mat result = cv::Mat::zeros(patch.size(), CV_32FC1);
  const int first = std::max(0, footprint.left()), last = std::min(result.cols, footprint.left() + footprint.width());
  for (int y = std::max(0, footprint.top()); y < std::min(result.rows, footprint.top() + footprint.height()); ++y) {
    const auto row = footprint.row(y);
    for (int x = first; x < last; ++x) result.at<float>(y, x) = row[static_cast<std::size_t>(x - footprint.left())];
  }
  return result;
}

std::vector<Vector<2>> half_level_curve(const cv::Mat& fraction, const ColourPatch& patch) {
  std::vector<Vector<2>> largest;
  double maximum = 0;
  LevelCurves curves(fraction);
  curves.for_each([&](const std::vector<Vector<2>>& curve) {
    const double area = geometry::polygon_area(curve);
    if (area <= maximum) return;
    maximum = area;
    largest = curve;
  });
  for (Vector<2>& point : largest) point = patch.pixel(point);
  return largest;
}

}  // namespace marey::track::contour::colour
