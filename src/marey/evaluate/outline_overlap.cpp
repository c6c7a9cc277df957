#include "marey/evaluate/outline_overlap.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace marey::evaluate {
namespace {

/// The columns, as fractions, at which a row of the lattice crosses the polygon, from the left. Between the first and the second
/// is inside, between the second and third outside, and so on.
void find_crossings(std::span<const Vector<2>> polygon, double y, int samples, std::vector<double>& crossings) {
  crossings.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector<2>& a = polygon[i];
    const Vector<2>& b = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    if ((a.y() <= y) == (b.y() <= y)) continue;
    const double x = a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    crossings.push_back((x + 0.5) * samples - 0.5);
  }
  std::sort(crossings.begin(), crossings.end());
}

}  // namespace

double OutlineOverlap::iou() const {
  const double all = outline + silhouette - shared;
  return all > 0 ? shared / all : 0;
}

OutlineOverlap visible_overlap(std::span<const Vector<2>> polygon, std::span<const std::vector<Vector<2>>> nearer,
                               const SilhouetteMask& truth, const cv::Size& image) {
  // What nearer ones cover is cut from both the curve and, where it is counted, the silhouette's share inside it.
  const double unit = 1.0 / (static_cast<double>(truth.samples) * truth.samples);
  const cv::Rect counted(0, 0, image.width * truth.samples, image.height * truth.samples);
  const cv::Rect lattice(truth.corner, truth.mask.size());
  OutlineOverlap result;
  const cv::Rect kept = lattice & counted;
  if (!kept.empty()) result.silhouette = unit * cv::countNonZero(truth.mask(kept - lattice.tl()));
  std::vector<double> crossings;
  for (int row = 0; row < counted.height && polygon.size() > 2; ++row) {
    const double y = (row + 0.5) / truth.samples - 0.5;
    find_crossings(polygon, y, truth.samples, crossings);
    if (crossings.empty()) continue;
    const int first = std::max(0, static_cast<int>(std::ceil(crossings.front())));
    const int last = std::min(counted.width, static_cast<int>(std::ceil(crossings.back())));
    if (last <= first) continue;
    std::vector<std::uint8_t> inside(static_cast<std::size_t>(last - first), 0);
    const auto mark = [&](std::uint8_t value) {
      for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
        const int begin = std::max(first, static_cast<int>(std::ceil(crossings[i])));
        const int end = std::min(last, static_cast<int>(std::ceil(crossings[i + 1])));
        for (int x = begin; x < end; ++x) inside[static_cast<std::size_t>(x - first)] = value;
      }
    };
    mark(1);
    for (const std::vector<Vector<2>>& one : nearer) {
      find_crossings(one, y, truth.samples, crossings);
      mark(0);
    }
    for (int x = first; x < last; ++x) {
      if (inside[static_cast<std::size_t>(x - first)] == 0) continue;
      result.outline += unit;
      const cv::Point at(x, row);
      if (lattice.contains(at) && truth.mask.at<std::uint8_t>(at - lattice.tl()) != 0) result.shared += unit;
    }
  }
  return result;
}

OutlineOverlap overlap(std::span<const Vector<2>> polygon, const SilhouetteMask& truth, const cv::Size* image) {
  const double unit = 1.0 / (static_cast<double>(truth.samples) * truth.samples);
  const cv::Rect lattice(truth.corner, truth.mask.size());
  constexpr int kFar = std::numeric_limits<int>::max() / 4;
  cv::Rect counted(-kFar, -kFar, 2 * kFar, 2 * kFar);
  if (image != nullptr) counted = {0, 0, image->width * truth.samples, image->height * truth.samples};
  OutlineOverlap result;
  const cv::Rect kept = lattice & counted;
  if (!kept.empty()) result.silhouette = unit * cv::countNonZero(truth.mask(kept - lattice.tl()));
  if (polygon.size() < 3) return result;

  const auto [low, high] =
      std::minmax_element(polygon.begin(), polygon.end(), [](const auto& a, const auto& b) { return a.y() < b.y(); });
  const int first = std::max(counted.y, static_cast<int>(std::ceil((low->y() + 0.5) * truth.samples - 0.5)));
  const int last = std::min(counted.br().y - 1, static_cast<int>(std::floor((high->y() + 0.5) * truth.samples - 0.5)));
  std::vector<double> crossings;
  for (int row = first; row <= last; ++row) {
    find_crossings(polygon, (row + 0.5) / truth.samples - 0.5, truth.samples, crossings);
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const int begin = std::max(counted.x, static_cast<int>(std::ceil(crossings[i])));
      const int end = std::min(counted.br().x, static_cast<int>(std::ceil(crossings[i + 1])));
      if (end <= begin) continue;
      result.outline += unit * (end - begin);
      const cv::Rect run = cv::Rect(begin, row, end - begin, 1) & lattice;
      if (!run.empty()) result.shared += unit * cv::countNonZero(truth.mask(run - lattice.tl()));
    }
  }
  return result;
}

}  // namespace marey::evaluate
