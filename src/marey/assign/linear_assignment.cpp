#include "marey/assign/linear_assignment.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

namespace marey::assign {

std::span<const int> LinearAssigner::assign(int rows, int columns, std::span<const double> costs) {
  assert(costs.size() == static_cast<std::size_t>(rows) * columns && "one cost for each pair");
  result_.assign(rows, kNoIndex);
  if (rows <= columns) {
    solve(rows, columns, costs.data());
    std::copy_n(column_of_row_.begin(), rows, result_.begin());
    return result_;
  }
  transposed_.resize(costs.size());
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      transposed_[static_cast<std::size_t>(column) * rows + row] = costs[static_cast<std::size_t>(row) * columns + column];
    }
  }
  solve(columns, rows, transposed_.data());
  for (int column = 0; column < columns; ++column) result_[column_of_row_[column]] = column;
  return result_;
}

void LinearAssigner::solve(int rows, int columns, const double* costs) {
  row_price_.assign(rows, 0);
  column_price_.assign(columns, 0);
  column_of_row_.assign(rows, kNoIndex);
  row_of_column_.assign(columns, kNoIndex);
  from_row_.assign(columns, kNoIndex);
  for (int row = 0; row < rows; ++row) {
    int column = find_path(row, columns, costs);
    row_price_[row] += path_cost_;
    for (int other = 0; other < rows; ++other) {
      if (row_observed_[other] && other != row) row_price_[other] += path_cost_ - shortest_[column_of_row_[other]];
    }
    for (int other = 0; other < columns; ++other) {
      if (column_observed_[other]) column_price_[other] -= path_cost_ - shortest_[other];
    }
    for (int owner = kNoIndex; owner != row;) {
      owner = from_row_[column];
      row_of_column_[column] = owner;
      std::swap(column_of_row_[owner], column);
    }
  }
}

/// Dijkstra from `row` to the nearest free column, which is returned; `from_row_` gives the path back.
int LinearAssigner::find_path(int row, int columns, const double* costs) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  shortest_.assign(columns, infinity);
  row_observed_.assign(column_of_row_.size(), 0);
  column_observed_.assign(columns, 0);
  // From the last to the first, so that where all costs are equal the pairs are (0, 0), (1, 1), ...
  remaining_.resize(columns);
  for (int i = 0; i < columns; ++i) remaining_[i] = columns - 1 - i;
  path_cost_ = 0;
  for (;;) {
    row_observed_[row] = 1;
    const double* row_costs = costs + static_cast<std::size_t>(row) * columns;
    double lowest = infinity;
    int best = kNoIndex;
    for (int i = 0; i < static_cast<int>(remaining_.size()); ++i) {
      const int column = remaining_[i];
      const double reached = path_cost_ + row_costs[column] - row_price_[row] - column_price_[column];
      if (reached < shortest_[column]) {
        from_row_[column] = row;
        shortest_[column] = reached;
      }
      const bool wins_draw = shortest_[column] == lowest && row_of_column_[column] == kNoIndex;
      if (best == kNoIndex || shortest_[column] < lowest || wins_draw) {
        lowest = shortest_[column];
        best = i;
      }
    }
    path_cost_ = lowest;
    const int column = remaining_[best];
    column_observed_[column] = 1;
    if (row_of_column_[column] == kNoIndex) return column;
    row = row_of_column_[column];
    remaining_[best] = remaining_.back();
    remaining_.pop_back();
  }
}

}  // namespace marey::assign
