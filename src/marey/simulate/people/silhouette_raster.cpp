// Convex shapes are filled row by row of a lattice finer than the pixels: each row meets a convex shape in one interval, so the
// cost is the number of points marked and no point is tested. The hull of two discs meets a row where the discs or the
// quadrangle of their tangents do.
#include "marey/simulate/people/silhouette_raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace marey::simulate::people {
namespace {

struct Interval {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  bool empty() const { return low > high; }
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

void add_disc(Interval& row, const Vector<2>& centre, double radius, double y) {
  const double half = radius * radius - (y - centre.y()) * (y - centre.y());
  if (half < 0) return;
  row.add(centre.x() - std::sqrt(half));
  row.add(centre.x() + std::sqrt(half));
}

void add_polygon(Interval& row, std::span<const Vector<2>> polygon, double y) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector<2>& a = polygon[i];
    const Vector<2>& b = polygon[(i + 1) % polygon.size()];
    if ((a.y() <= y) == (b.y() <= y)) continue;
    row.add(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
  }
}

/// The corners of the tangents that touch both discs; nothing if one disc holds the other.
std::optional<std::array<Vector<2>, 4>> tangents(const RoundCone2& shape) {
  const Vector<2> d = shape.to - shape.from;
  const double length = d.norm();
  if (length <= std::abs(shape.from_radius - shape.to_radius)) return std::nullopt;
  const Vector<2> along = d / length;
  const Vector<2> across(-along.y(), along.x());
  const double sine = (shape.from_radius - shape.to_radius) / length;
  const double cosine = std::sqrt(1 - sine * sine);
  const Vector<2> one = sine * along + cosine * across;
  const Vector<2> other = sine * along - cosine * across;
  return std::array<Vector<2>, 4>{shape.from + shape.from_radius * one, shape.to + shape.to_radius * one,
                                  shape.to + shape.to_radius * other, shape.from + shape.from_radius * other};
}

void fill_row(Silhouette& silhouette, int row, const Interval& px, std::uint8_t value, int shades) {
  const double samples = silhouette.samples;
  const double left = (px.low + 0.5) * samples - 0.5 - silhouette.lattice.x;
  const double right = (px.high + 0.5) * samples - 0.5 - silhouette.lattice.x;
  const int begin = std::max(0, static_cast<int>(std::ceil(left)));
  const int end = std::min(silhouette.mask.cols, static_cast<int>(std::floor(right)) + 1);
  auto* out = silhouette.mask.ptr<std::uint8_t>(row);
  const double step = shades / std::max(1.0, right - left);
  for (int x = begin; x < end; ++x) {
    const int shade = shades > 1 ? std::clamp(static_cast<int>((x - left) * step), 0, shades - 1) : 0;
    out[x] = static_cast<std::uint8_t>(value + shade);
  }
}

template <typename RowOf>
void fill_rows(Silhouette& silhouette, double top, double bottom, std::uint8_t value, int shades, const RowOf& row_of) {
  const double samples = silhouette.samples;
  const int first = std::max(0, static_cast<int>(std::ceil((top + 0.5) * samples - 0.5)) - silhouette.lattice.y);
  const int last =
      std::min(silhouette.mask.rows - 1, static_cast<int>(std::floor((bottom + 0.5) * samples - 0.5)) - silhouette.lattice.y);
  for (int row = first; row <= last; ++row) {
    const Interval px = row_of((row + silhouette.lattice.y + 0.5) / samples - 0.5);
    if (!px.empty()) fill_row(silhouette, row, px, value, shades);
  }
}

}  // namespace

cv::Rect Silhouette::pixels() const {
  return {lattice.x / samples, lattice.y / samples, lattice.width / samples, lattice.height / samples};
}

double Silhouette::area() const {
  return empty() ? 0 : static_cast<double>(cv::countNonZero(mask)) / (samples * samples);
}

Box Silhouette::box() const {
  int left = mask.cols, right = -1, top = -1, bottom = -1;
  for (int y = 0; y < mask.rows; ++y) {
    const auto* row = mask.ptr<std::uint8_t>(y);
    int first = 0, last = mask.cols - 1;
    while (first < mask.cols && row[first] == 0) ++first;
    if (first == mask.cols) continue;
    while (row[last] == 0) --last;
    left = std::min(left, first);
    right = std::max(right, last);
    if (top < 0) top = y;
    bottom = y;
  }
  if (right < 0) return {};
  const double step = 1.0 / samples;
  return {(lattice.x + left) * step, (lattice.y + top) * step, (right - left + 1) * step, (bottom - top + 1) * step};
}

Vector<2> Silhouette::centre() const {
  double count = 0, sum_x = 0, sum_y = 0;
  for (int y = 0; y < mask.rows; ++y) {
    const auto* row = mask.ptr<std::uint8_t>(y);
    for (int x = 0; x < mask.cols; ++x) {
      if (row[x] == 0) continue;
      count += 1;
      sum_x += x;
      sum_y += y;
    }
  }
  return {(lattice.x + sum_x / count + 0.5) / samples - 0.5, (lattice.y + sum_y / count + 0.5) / samples - 0.5};
}

cv::Mat Silhouette::pixel_mask(cv::Size image) const {
  cv::Mat out = cv::Mat::zeros(image, CV_8UC1);
  const cv::Rect all = pixels();
  const cv::Rect shown = all & cv::Rect({0, 0}, image);
  for (int y = shown.y; y < shown.br().y; ++y) {
    for (int x = shown.x; x < shown.br().x; ++x) {
      const cv::Rect cell((x - all.x) * samples, (y - all.y) * samples, samples, samples);
      if (2 * cv::countNonZero(mask(cell)) >= samples * samples) out.at<std::uint8_t>(y, x) = 255;
    }
  }
  return out;
}

void take_away(Silhouette& silhouette, const Silhouette& front) {
  const cv::Rect shared = silhouette.lattice & front.lattice;
  if (shared.empty()) return;
  silhouette.mask(shared - silhouette.lattice.tl()).setTo(0, front.mask(shared - front.lattice.tl()));
}

void crop(Silhouette& silhouette, cv::Size image) {
  const cv::Rect all({0, 0}, image * silhouette.samples);
  const cv::Rect kept = silhouette.lattice & all;
  if (kept == silhouette.lattice) return;
  silhouette.mask = kept.empty() ? cv::Mat() : silhouette.mask(kept - silhouette.lattice.tl()).clone();
  silhouette.lattice = kept;
}

Silhouette blank_silhouette(const Box& box, int samples) {
  Silhouette silhouette;
  silhouette.samples = samples;
  if (box.empty()) return silhouette;
  const int left = static_cast<int>(std::floor(box.left));
  const int top = static_cast<int>(std::floor(box.top));
  const int width = static_cast<int>(std::ceil(box.right())) - left;
  const int height = static_cast<int>(std::ceil(box.bottom())) - top;
  silhouette.lattice = {left * samples, top * samples, width * samples, height * samples};
  silhouette.mask = cv::Mat::zeros(silhouette.lattice.size(), CV_8UC1);
  return silhouette;
}

Box bounds(const RoundCone2& shape) {
  const double left = std::min(shape.from.x() - shape.from_radius, shape.to.x() - shape.to_radius);
  const double top = std::min(shape.from.y() - shape.from_radius, shape.to.y() - shape.to_radius);
  const double right = std::max(shape.from.x() + shape.from_radius, shape.to.x() + shape.to_radius);
  const double bottom = std::max(shape.from.y() + shape.from_radius, shape.to.y() + shape.to_radius);
  return {left + 0.5, top + 0.5, right - left, bottom - top};
}

Box bounds(std::span<const Vector<2>> polygon) {
  Interval x, y;
  for (const Vector<2>& corner : polygon) {
    x.add(corner.x());
    y.add(corner.y());
  }
  if (x.empty()) return {};
  return {x.low + 0.5, y.low + 0.5, x.high - x.low, y.high - y.low};
}

void fill(Silhouette& silhouette, const RoundCone2& shape, std::uint8_t value, int shades) {
  const Box box = bounds(shape);
  const auto quadrangle = tangents(shape);
  fill_rows(silhouette, box.top - 0.5, box.bottom() - 0.5, value, shades, [&](double y) {
    Interval row;
    add_disc(row, shape.from, shape.from_radius, y);
    add_disc(row, shape.to, shape.to_radius, y);
    if (quadrangle) add_polygon(row, *quadrangle, y);
    return row;
  });
}

void fill_convex(Silhouette& silhouette, std::span<const Vector<2>> polygon, std::uint8_t value, int shades) {
  const Box box = bounds(polygon);
  fill_rows(silhouette, box.top - 0.5, box.bottom() - 0.5, value, shades, [&](double y) {
    Interval row;
    add_polygon(row, polygon, y);
    return row;
  });
}

}  // namespace marey::simulate::people
