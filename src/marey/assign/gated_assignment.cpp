#include "marey/assign/gated_assignment.h"

#include <algorithm>
#include <tuple>

namespace marey::assign {

void GatedAssigner::find_components(int rows, int columns, std::span<const GatedPair> pairs) {
  components_.reset(rows + columns);
  grouped_.clear();
  for (const GatedPair& pair : pairs) {
    if (!(pair.gain > 0)) continue;
    grouped_.push_back(pair);
    components_.join(pair.row, rows + pair.column);  // named by the lowest row, whatever the order of the pairs
  }
  std::sort(grouped_.begin(), grouped_.end(), [this](const GatedPair& a, const GatedPair& b) {
    return std::tuple(components_.find(a.row), a.row, a.column) < std::tuple(components_.find(b.row), b.row, b.column);
  });
}

std::span<const int> GatedAssigner::assign(int rows, int columns, std::span<const GatedPair> pairs) {
  column_of_row_.assign(rows, kNoIndex);
  column_slot_.assign(columns, kNoIndex);
  taken_.assign(columns, 0);
  find_components(rows, columns, pairs);
  const std::span<GatedPair> all(grouped_);
  for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    const int root = components_.find(all[begin].row);
    while (end < all.size() && components_.find(all[end].row) == root) ++end;
    if (end - begin == 1) {
      column_of_row_[all[begin].row] = all[begin].column;
    } else {
      solve_component(all.subspan(begin, end - begin));
    }
  }
  return column_of_row_;
}

void GatedAssigner::name_nodes(std::span<const GatedPair> pairs) {
  row_names_.clear();
  column_names_.clear();
  for (const GatedPair& pair : pairs) {
    if (row_names_.empty() || row_names_.back() != pair.row) row_names_.push_back(pair.row);
    if (column_slot_[pair.column] != kNoIndex) continue;
    column_slot_[pair.column] = static_cast<int>(column_names_.size());
    column_names_.push_back(pair.column);
  }
}

void GatedAssigner::solve_component(std::span<GatedPair> pairs) {
  name_nodes(pairs);
  const int rows = static_cast<int>(row_names_.size());
  const int columns = static_cast<int>(column_names_.size());
  if (std::max(rows, columns) > largest_component) {
    solve_greedily(pairs);
    return;
  }
  const auto at = [columns](int row, int slot) { return static_cast<std::size_t>(row) * columns + slot; };
  costs_.assign(static_cast<std::size_t>(rows) * columns, 0);
  int row = 0;
  for (const GatedPair& pair : pairs) {
    if (row_names_[row] != pair.row) ++row;
    costs_[at(row, column_slot_[pair.column])] = -pair.gain;
  }
  const auto slots = dense_.assign(rows, columns, costs_);
  for (row = 0; row < rows; ++row) {
    const int slot = slots[row];
    if (slot != kNoIndex && costs_[at(row, slot)] < 0) column_of_row_[row_names_[row]] = column_names_[slot];
  }
}

void GatedAssigner::solve_greedily(std::span<GatedPair> pairs) {
  std::sort(pairs.begin(), pairs.end(), [](const GatedPair& a, const GatedPair& b) {
    return a.gain != b.gain ? a.gain > b.gain : std::tuple(a.row, a.column) < std::tuple(b.row, b.column);
  });
  for (const GatedPair& pair : pairs) {
    if (taken_[pair.column] || column_of_row_[pair.row] != kNoIndex) continue;
    column_of_row_[pair.row] = pair.column;
    taken_[pair.column] = 1;
  }
}

}  // namespace marey::assign
