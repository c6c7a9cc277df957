#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "marey/core/geometry.h"

namespace marey {

/// A binary mask of an image in runs, as COCO and MOTS files contain it: pixels column by column from the left, in a column from
/// the top; the lengths of runs alternately of pixels outside (first, perhaps 0) and inside. Their sum is width × height.
struct RunMask {
  int width = 0, height = 0;        ///< px, of the image
  std::vector<std::uint32_t> runs;  ///< only the first may be 0

  bool operator==(const RunMask&) const = default;

  std::int64_t area() const {
    std::int64_t sum = 0;
    for (std::size_t i = 1; i < runs.size(); i += 2) sum += runs[i];
    return sum;
  }

  /// The pixels whose centre is within a closed polygon (px; the even-odd rule), of an image of this size.
  static RunMask of_polygon(std::span<const Vector<2>> polygon, int width, int height);

  /// The box of its pixels, px; empty without any.
  Box box() const;
};

/// Appends runs; a run of the same kind as the last one lengthens it.
class RunMaskBuilder {
 public:
  RunMaskBuilder(int width, int height) { mask_ = {width, height, {}}; }

  void add(bool inside, std::uint32_t length) {
    if (length == 0) return;
    const bool last_inside = mask_.runs.size() % 2 == 0;  // the second, fourth, … run is inside
    if (mask_.runs.empty()) {
      if (inside) mask_.runs.push_back(0);
      mask_.runs.push_back(length);
    } else if (last_inside == inside) {
      mask_.runs.back() += length;
    } else {
      mask_.runs.push_back(length);
    }
  }
  RunMask take() { return std::move(mask_); }

 private:
  RunMask mask_;
};

/// Calls `visit(inside_a, inside_b, length)` for each run of pixels that are alike in both masks, which have the same size.
template <typename Visit>
void for_common_runs(const RunMask& a, const RunMask& b, const Visit& visit) {
  assert(a.width == b.width && a.height == b.height && "masks of one image");
  std::size_t i = 0, j = 0;
  std::uint32_t left_a = a.runs.empty() ? 0 : a.runs[0], left_b = b.runs.empty() ? 0 : b.runs[0];
  for (;;) {
    while (left_a == 0 && ++i < a.runs.size()) left_a = a.runs[i];
    while (left_b == 0 && ++j < b.runs.size()) left_b = b.runs[j];
    if (left_a == 0 || left_b == 0) return;
    const std::uint32_t length = std::min(left_a, left_b);
    visit(i % 2 == 1, j % 2 == 1, length);
    left_a -= length;
    left_b -= length;
  }
}

inline std::int64_t shared_area(const RunMask& a, const RunMask& b) {
  std::int64_t area = 0;
  for_common_runs(a, b, [&](bool in_a, bool in_b, std::uint32_t length) { area += in_a && in_b ? length : 0; });
  return area;
}

/// `a` without the pixels of `b`.
inline RunMask without(const RunMask& a, const RunMask& b) {
  RunMaskBuilder rest(a.width, a.height);
  for_common_runs(a, b, [&](bool in_a, bool in_b, std::uint32_t length) { rest.add(in_a && !in_b, length); });
  return rest.take();
}

/// Intersection over union; 0 if both are empty.
inline double iou(const RunMask& a, const RunMask& b) {
  const std::int64_t shared = shared_area(a, b), all = a.area() + b.area() - shared;
  return all > 0 ? static_cast<double>(shared) / static_cast<double>(all) : 0;
}

inline RunMask RunMask::of_polygon(std::span<const Vector<2>> polygon, int width, int height) {
  RunMaskBuilder mask(width, height);
  std::vector<double> crossings;
  double left = width, right = -1;
  for (const Vector<2>& corner : polygon) {
    left = std::min(left, corner.x());
    right = std::max(right, corner.x());
  }
  const int first = static_cast<int>(std::clamp(std::ceil(left), 0.0, static_cast<double>(width)));
  const int last = std::max(first, static_cast<int>(std::clamp(std::floor(right) + 1, 0.0, static_cast<double>(width))));
  mask.add(false, static_cast<std::uint32_t>(first) * static_cast<std::uint32_t>(height));
  for (int x = first; x < last; ++x) {
    crossings.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vector<2>&a = polygon[i], &b = polygon[i + 1 < polygon.size() ? i + 1 : 0];
      if ((a.x() <= x) == (b.x() <= x)) continue;
      crossings.push_back(a.y() + (x - a.x()) / (b.x() - a.x()) * (b.y() - a.y()));
    }
    std::sort(crossings.begin(), crossings.end());
    int row = 0;
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const int begin = std::clamp(static_cast<int>(std::ceil(std::clamp(crossings[i], -1.0, height + 1.0))), row, height);
      const int end = std::clamp(static_cast<int>(std::ceil(std::clamp(crossings[i + 1], -1.0, height + 1.0))), begin, height);
      mask.add(false, static_cast<std::uint32_t>(begin - row));
      mask.add(true, static_cast<std::uint32_t>(end - begin));
      row = end;
    }
    mask.add(false, static_cast<std::uint32_t>(height - row));
  }
  mask.add(false, static_cast<std::uint32_t>(width - last) * static_cast<std::uint32_t>(height));
  return mask.take();
}

inline Box RunMask::box() const {
  std::int64_t at = 0, left = width, right = -1, top = height, bottom = -1;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::int64_t end = at + runs[i];
    if (i % 2 == 1 && end > at) {
      const std::int64_t first = at / height, last = (end - 1) / height;
      left = std::min(left, first);
      right = std::max(right, last);
      top = std::min(top, first == last ? at % height : 0);
      bottom = std::max(bottom, first == last ? (end - 1) % height : height - 1);
    }
    at = end;
  }
  if (right < left) return {};
  return {static_cast<double>(left), static_cast<double>(top), static_cast<double>(right - left + 1),
          static_cast<double>(bottom - top + 1)};
}

/// One mask of a table: truth or a tracker's result.
struct LabelledMask {
  std::int32_t frame = 0;  ///< counts from 0
  std::int32_t id = 0;
  RunMask mask;
};

}  // namespace marey
