#pragma once

#include <vector>

#include "marey/core/geometry.h"

namespace marey::track::ground {

/// A grid of square cells over a part of the ground.
struct GroundGrid {
  Vector<2> corner = Vector<2>::Zero();  ///< m, of least x and y
  double cell = 1;                       ///< m
  int columns = 1, rows = 1;

  /// Over a rectangle, cells of at least `cell` m, at most 300 a side.
  static GroundGrid over(const Vector<2>& minimum, const Vector<2>& maximum, double cell);

  /// Of the cell that holds a place, or of the nearest.
  std::size_t index(const Vector<2>& location) const;
  std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};

/// Sums in the cells of a grid, spread by a Gaussian: `sigma` in m, its weight 1 in the middle. Cost: cells times its width.
std::vector<double> spread_over(const GroundGrid& grid, const std::vector<double>& sums, double sigma);

/// A smooth displacement of the ground.
class GroundField {
 public:
  explicit GroundField(const GroundGrid& grid) : grid_(grid), x_(grid.size(), 0), y_(grid.size(), 0) {}

  /// m; between the middles of cells it is linear, beyond the grid as at its edge.
  Vector<2> at(const Vector<2>& location) const;
  void add(std::size_t cell, const Vector<2>& displacement) { x_[cell] += displacement.x(), y_[cell] += displacement.y(); }
  const GroundGrid& grid() const { return grid_; }

 private:
  GroundGrid grid_;
  std::vector<double> x_, y_;
};

}  // namespace marey::track::ground
