// Finds the points near a place. Points are sorted by the cell of a regular grid they fall in, cells in lexicographic order, so
// that the cells of one grid row are contiguous: a query is one binary search a row and a walk along it. Building costs n log n,
// a query log n a grid row plus the points of the cells touched; with cells as wide as the queries that is near constant.
// Nothing is allocated once the largest frame has been seen.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "marey/core/geometry.h"

namespace marey::assign {

template <int D>
class PointGrid {
 public:
  /// `points` must be finite; `cell` > 0 is the side of a cell. Cells grow where the points are too far apart to be numbered.
  void build(std::span<const Vector<D>> points, double cell) {
    points_.assign(points.begin(), points.end());
    entries_.clear();
    if (points.empty()) return;
    origin_ = points_.front();
    Vector<D> last = origin_;
    for (const Vector<D>& point : points_) {
      origin_ = origin_.cwiseMin(point);
      last = last.cwiseMax(point);
    }
    cell_ = std::max(cell, (last - origin_).maxCoeff() / max_cell);
    for (int i = 0; i < D; ++i) extent_[i] = (last[i] - origin_[i]) / cell_;
    for (int i = 0; i < static_cast<int>(points_.size()); ++i) entries_.push_back({key(cell_of(points_[i])), i});
    std::sort(entries_.begin(), entries_.end());
  }

  /// Calls `visit(index)` for every point within `radius` of `centre`, and perhaps others nearby, each once, in an order that
  /// depends on the points alone.
  template <typename Visit>
  void for_each_near(const Vector<D>& centre, double radius, Visit&& visit) const {
    if (points_.empty()) return;
    const Cell first = cell_of(centre - Vector<D>::Constant(radius));
    const Cell last = cell_of(centre + Vector<D>::Constant(radius));
    double rows = 1;
    for (int i = 0; i + 1 < D; ++i) rows *= static_cast<double>(last[i] - first[i] + 1);
    if (rows > static_cast<double>(points_.size())) {
      for (const Entry& entry : entries_) visit(entry.index);
      return;
    }
    Cell row = first;
    for (;;) {
      visit_row(row, last[D - 1], visit);
      int axis = D - 2;
      while (axis >= 0 && row[axis] == last[axis]) {
        row[axis] = first[axis];
        --axis;
      }
      if (axis < 0) return;
      ++row[axis];
    }
  }

 private:
  using Cell = std::array<std::int64_t, D>;
  struct Entry {
    std::uint64_t key;
    int index;
    auto operator<=>(const Entry&) const = default;
  };
  static constexpr int bits = 64 / D > 21 ? 21 : 64 / D;
  static constexpr double max_cell = (1 << bits) - 1;

  /// Clamped to the cells that hold points: what lies outside belongs to a border cell.
  Cell cell_of(const Vector<D>& point) const {
    Cell cell;
    for (int i = 0; i < D; ++i) {
      cell[i] = static_cast<std::int64_t>(std::clamp((point[i] - origin_[i]) / cell_, 0.0, extent_[i]));
    }
    return cell;
  }

  static std::uint64_t key(const Cell& cell) {
    std::uint64_t key = 0;
    for (const std::int64_t coordinate : cell) key = key << bits | static_cast<std::uint64_t>(coordinate);
    return key;
  }

  template <typename Visit>
  void visit_row(Cell from, std::int64_t last, Visit& visit) const {
    Cell to = from;
    to[D - 1] = last;
    const std::uint64_t end = key(to);
    auto entry = std::lower_bound(entries_.begin(), entries_.end(), Entry{key(from), 0});
    for (; entry != entries_.end() && entry->key <= end; ++entry) visit(entry->index);
  }

  std::vector<Vector<D>> points_;
  std::vector<Entry> entries_;
  Vector<D> origin_ = Vector<D>::Zero();
  Vector<D> extent_ = Vector<D>::Zero();  // in cells
  double cell_ = 1;
};

}  // namespace marey::assign
