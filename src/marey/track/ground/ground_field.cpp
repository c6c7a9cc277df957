#include "marey/track/ground/ground_field.h"

#include <algorithm>
#include <cmath>

namespace marey::track::ground {
namespace {

constexpr int kMaxCells = 300;  // a side

/// Spread along the rows' order: each row becomes the weighted sum of those within reach, whole rows at a time.
std::vector<double> spread_rows(const std::vector<double>& values, int rows, int columns, const std::vector<double>& weights) {
  const int reach = static_cast<int>(weights.size()) - 1;
  std::vector<double> spread(values.size(), 0);
  for (int row = 0; row < rows; ++row) {
    double* const to = spread.data() + static_cast<std::ptrdiff_t>(row) * columns;
    for (int other = std::max(0, row - reach); other <= std::min(rows - 1, row + reach); ++other) {
      const double weight = weights[static_cast<std::size_t>(std::abs(row - other))];
      const double* const from = values.data() + static_cast<std::ptrdiff_t>(other) * columns;
      for (int column = 0; column < columns; ++column) to[column] += weight * from[column];
    }
  }
  return spread;
}

std::vector<double> transposed(const std::vector<double>& values, int rows, int columns) {
  std::vector<double> rotated(values.size());
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column)
      rotated[static_cast<std::size_t>(column) * static_cast<std::size_t>(rows) + static_cast<std::size_t>(row)] =
          values[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  }
  return rotated;
}

}  // namespace

GroundGrid GroundGrid::over(const Vector<2>& minimum, const Vector<2>& maximum, double cell) {
  GroundGrid grid;
  const Vector<2> size = (maximum - minimum).cwiseMax(0.0);
  grid.corner = minimum;
  grid.cell = std::max(cell, size.maxCoeff() / kMaxCells);
  grid.columns = static_cast<int>(size.x() / grid.cell) + 1;
  grid.rows = static_cast<int>(size.y() / grid.cell) + 1;
  return grid;
}

std::size_t GroundGrid::index(const Vector<2>& location) const {
  const Vector<2> at = (location - corner) / cell;
  const auto column = static_cast<std::size_t>(std::clamp(at.x(), 0.0, columns - 1.0));
  const auto row = static_cast<std::size_t>(std::clamp(at.y(), 0.0, rows - 1.0));
  return row * static_cast<std::size_t>(columns) + column;
}

std::vector<double> spread_over(const GroundGrid& grid, const std::vector<double>& sums, double sigma) {
  std::vector<double> weights;
  for (int k = 0; k * grid.cell <= 3 * sigma; ++k) weights.push_back(std::exp(-0.5 * std::pow(k * grid.cell / sigma, 2)));
  const std::vector<double> across = spread_rows(transposed(sums, grid.rows, grid.columns), grid.columns, grid.rows, weights);
  return spread_rows(transposed(across, grid.columns, grid.rows), grid.rows, grid.columns, weights);
}

Vector<2> GroundField::at(const Vector<2>& location) const {
  const Vector<2> at = (location - grid_.corner) / grid_.cell - Vector<2>(0.5, 0.5);
  const double x = std::clamp(at.x(), 0.0, grid_.columns - 1.0), y = std::clamp(at.y(), 0.0, grid_.rows - 1.0);
  const int left = static_cast<int>(x), low = static_cast<int>(y);
  const auto value = [&](int column, int row) {
    const auto cell = static_cast<std::size_t>(std::min(row, grid_.rows - 1)) * static_cast<std::size_t>(grid_.columns) +
                      static_cast<std::size_t>(std::min(column, grid_.columns - 1));
    return Vector<2>(x_[cell], y_[cell]);
  };
  const double u = x - left, v = y - low;
  return (1 - v) * ((1 - u) * value(left, low) + u * value(left + 1, low)) +
         v * ((1 - u) * value(left, low + 1) + u * value(left + 1, low + 1));
}

}  // namespace marey::track::ground
