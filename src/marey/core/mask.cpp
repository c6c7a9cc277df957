#include "marey/core/mask.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace marey {
namespace {

/// Whether a place lies on the edge from `a` to `b`, by a hundredth of a pixel.
bool on_edge(const Vector<2>& location, const Vector<2>& a, const Vector<2>& b) {
  const Vector<2> edge = b - a;
  const double length2 = edge.squaredNorm();
  const double along = length2 > 0 ? std::clamp((location - a).dot(edge) / length2, 0.0, 1.0) : 0;
  return (location - a - along * edge).norm() < 0.01;
}

/// By the crossings of its edges with the ray to the right.
bool in_polygon(const std::vector<cv::Point>& corners, const Vector<2>& location) {
  bool within = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const cv::Point& from = corners[i > 0 ? i - 1 : corners.size() - 1];
    const Vector<2> a(from.x, from.y), b(corners[i].x, corners[i].y);
    if (on_edge(location, a, b)) return true;
    if ((a.y() > location.y()) == (b.y() > location.y())) continue;
    if (location.x() < a.x() + (location.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) within = !within;
  }
  return within;
}

}  // namespace

Mask Mask::polygon(std::vector<cv::Point> corners) {
  cv::Point low = corners.front(), high = low;
  for (const cv::Point& corner : corners) {
    low = {std::min(low.x, corner.x), std::min(low.y, corner.y)};
    high = {std::max(high.x, corner.x), std::max(high.y, corner.y)};
  }
  Mask mask(cv::Rect(low, high + cv::Point(1, 1)));
  mask.corners_ = std::move(corners);
  return mask;
}

std::optional<Mask> Mask::of_numbers(std::span<const int> numbers) {
  if (std::any_of(numbers.begin(), numbers.end(), [](int each) { return each < 0 || each > kMaxDistance; })) return std::nullopt;
  if (numbers.size() == 4) {
    if (numbers[2] < 1 || numbers[3] < 1) return std::nullopt;
    return Mask(numbers[0], numbers[1], numbers[2], numbers[3]);
  }
  if (numbers.size() < 6 || numbers.size() % 2 != 0 || numbers.size() > 2 * kMaxCorners) return std::nullopt;
  std::vector<cv::Point> corners;
  for (std::size_t i = 0; i < numbers.size(); i += 2) corners.emplace_back(numbers[i], numbers[i + 1]);
  return polygon(std::move(corners));
}

std::vector<int> Mask::numbers() const {
  if (corners_.empty()) return {box_.x, box_.y, box_.width, box_.height};
  std::vector<int> all;
  for (const cv::Point& corner : corners_) all.insert(all.end(), {corner.x, corner.y});
  return all;
}

bool Mask::contains(const Vector<2>& pixel) const {
  const Vector<2> within = pixel - Vector<2>(box_.x - 0.5, box_.y - 0.5), size(box_.width, box_.height);
  const bool in_box = (within.array() >= 0).all() && (within.array() < size.array()).all();
  return in_box && (corners_.empty() || in_polygon(corners_, pixel));
}

Mask Mask::scaled(double factor) const {
  if (!corners_.empty()) {
    const auto moved = [&](int value) { return static_cast<int>(std::lround((value + 0.5) * factor - 0.5)); };
    std::vector<cv::Point> corners;
    for (const cv::Point& corner : corners_) corners.emplace_back(std::max(0, moved(corner.x)), std::max(0, moved(corner.y)));
    return polygon(std::move(corners));
  }
  const auto low = [&](int value) { return static_cast<int>(std::floor(value * factor)); };
  const auto high = [&](int value) { return static_cast<int>(std::ceil(value * factor)); };
  return cv::Rect(cv::Point(low(box_.x), low(box_.y)), cv::Point(high(box_.br().x), high(box_.br().y)));
}

}  // namespace marey
