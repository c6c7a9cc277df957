#include "marey/assign/gated_assignment.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace marey {

int GatedAssigner::root_of(int node) {
  while (parent_[node] != node) {
    parent_[node] = parent_[parent_[node]];
    node = parent_[node];
  }
  return node;
}

void GatedAssigner::find_components(int rows, int columns, std::span<const GatedPair> pairs) {
  parent_.resize(rows + columns);
  std::iota(parent_.begin(), parent_.end(), 0);
  grouped_.clear();
  for (const GatedPair& pair : pairs) {
    if (!(pair.gain > 0)) continue;
    grouped_.push_back(pair);
    const int a = root_of(pair.row);
    const int b = root_of(rows + pair.column);
    parent_[std::max(a, b)] = std::min(a, b);  // the root is the lowest row, whatever the order of the pairs
  }
  std::sort(grouped_.begin(), grouped_.end(), [this](const GatedPair& a, const GatedPair& b) {
    return std::tuple(root_of(a.row), a.row, a.column) < std::tuple(root_of(b.row), b.row, b.column);
  });
}

std::span<const int> GatedAssigner::assign(int rows, int columns, std::span<const GatedPair> pairs) {
  column_of_row_.assign(rows, nobody);
  column_slot_.assign(columns, nobody);
  find_components(rows, columns, pairs);
  const std::span<const GatedPair> all(grouped_);
  for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    const int root = root_of(all[begin].row);
    while (end < all.size() && root_of(all[end].row) == root) ++end;
    if (end - begin == 1) {
      column_of_row_[all[begin].row] = all[begin].column;
    } else {
      solve_component(all.subspan(begin, end - begin));
    }
  }
  return column_of_row_;
}

void GatedAssigner::solve_component(std::span<const GatedPair> pairs) {
  row_names_.clear();
  column_names_.clear();
  for (const GatedPair& pair : pairs) {
    if (row_names_.empty() || row_names_.back() != pair.row) row_names_.push_back(pair.row);
    if (column_slot_[pair.column] == nobody) {
      column_slot_[pair.column] = static_cast<int>(column_names_.size());
      column_names_.push_back(pair.column);
    }
  }
  const int rows = static_cast<int>(row_names_.size());
  const int real = static_cast<int>(column_names_.size());
  const int columns = real + rows;  // each row may have a column of its own that means nobody
  cost_.assign(static_cast<std::size_t>(rows) * columns, 0);
  int row = 0;
  for (const GatedPair& pair : pairs) {
    if (row_names_[row] != pair.row) ++row;
    cost_[static_cast<std::size_t>(row) * columns + column_slot_[pair.column]] = -pair.gain;
  }
  row_price_.assign(rows, 0);
  column_price_.assign(columns, 0);
  row_of_column_.assign(columns, nobody);
  for (row = 0; row < rows; ++row) augment(row, columns);
  for (int slot = 0; slot < real; ++slot) {
    row = row_of_column_[slot];
    // A pair outside the gate costs 0 as nobody does, and means nobody.
    if (row != nobody && cost_[static_cast<std::size_t>(row) * columns + slot] < 0)
      column_of_row_[row_names_[row]] = column_names_[slot];
  }
}

// Dijkstra from `row` over reduced costs to the nearest free column; then prices and matches change along the path.
void GatedAssigner::augment(int row, int columns) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  shortest_.assign(columns, infinity);
  from_column_.assign(columns, nobody);
  done_.assign(columns, 0);
  int current_row = row;
  int current_column = nobody;
  double length = 0;
  int sink = nobody;
  while (sink == nobody) {
    int nearest = nobody;
    const double* costs = &cost_[static_cast<std::size_t>(current_row) * columns];
    for (int column = 0; column < columns; ++column) {
      if (done_[column]) continue;
      const double reached = length + costs[column] - row_price_[current_row] - column_price_[column];
      if (reached < shortest_[column]) {
        shortest_[column] = reached;
        from_column_[column] = current_column;
      }
      if (nearest == nobody || shortest_[column] < shortest_[nearest]) nearest = column;
    }
    length = shortest_[nearest];
    done_[nearest] = 1;
    current_column = nearest;
    if (row_of_column_[nearest] == nobody) {
      sink = nearest;
    } else {
      current_row = row_of_column_[nearest];
    }
  }
  row_price_[row] += length;
  for (int column = 0; column < columns; ++column) {
    if (!done_[column] || column == sink) continue;
    row_price_[row_of_column_[column]] += length - shortest_[column];
    column_price_[column] -= length - shortest_[column];
  }
  for (int column = sink; column != nobody;) {
    const int previous = from_column_[column];
    row_of_column_[column] = previous == nobody ? row : row_of_column_[previous];
    column = previous;
  }
}

}  // namespace marey
