#include "marey/track/ground/ground_field.h"

#include <algorithm>
#include <cmath>

namespace marey::track::ground {
namespace {

constexpr int kMostCells = 300;  // a side

/// One line of cells, `step` apart, from `first` on.
void spread_line(std::vector<double>& values, std::size_t first, std::size_t step, int count, const std::vector<double>& weights) {
  const int reach = static_cast<int>(weights.size()) - 1;
  std::vector<double> line(static_cast<std::size_t>(count), 0);
  for (int i = 0; i < count; ++i) {
    for (int k = std::max(0, i - reach); k <= std::min(count - 1, i + reach); ++k)
      line[static_cast<std::size_t>(i)] +=
          weights[static_cast<std::size_t>(std::abs(i - k))] * values[first + static_cast<std::size_t>(k) * step];
  }
  for (int i = 0; i < count; ++i) values[first + static_cast<std::size_t>(i) * step] = line[static_cast<std::size_t>(i)];
}

}  // namespace

GroundGrid GroundGrid::over(const Vector<2>& least, const Vector<2>& most, double cell) {
  GroundGrid grid;
  const Vector<2> size = (most - least).cwiseMax(0.0);
  grid.corner = least;
  grid.cell = std::max(cell, size.maxCoeff() / kMostCells);
  grid.columns = static_cast<int>(size.x() / grid.cell) + 1;
  grid.rows = static_cast<int>(size.y() / grid.cell) + 1;
  return grid;
}

std::size_t GroundGrid::index(const Vector<2>& place) const {
  const Vector<2> at = (place - corner) / cell;
  const auto column = static_cast<std::size_t>(std::clamp(at.x(), 0.0, columns - 1.0));
  const auto row = static_cast<std::size_t>(std::clamp(at.y(), 0.0, rows - 1.0));
  return row * static_cast<std::size_t>(columns) + column;
}

std::vector<double> spread_over(const GroundGrid& grid, const std::vector<double>& sums, double sigma) {
  std::vector<double> weights;
  for (int k = 0; k * grid.cell <= 3 * sigma; ++k) weights.push_back(std::exp(-0.5 * std::pow(k * grid.cell / sigma, 2)));
  std::vector<double> values = sums;
  const auto columns = static_cast<std::size_t>(grid.columns);
  for (int row = 0; row < grid.rows; ++row) spread_line(values, static_cast<std::size_t>(row) * columns, 1, grid.columns, weights);
  for (std::size_t column = 0; column < columns; ++column) spread_line(values, column, columns, grid.rows, weights);
  return values;
}

Vector<2> GroundField::at(const Vector<2>& place) const {
  const Vector<2> at = (place - grid_.corner) / grid_.cell - Vector<2>(0.5, 0.5);
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
