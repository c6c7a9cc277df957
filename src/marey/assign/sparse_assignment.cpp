#include "marey/assign/sparse_assignment.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <utility>

namespace marey::assign {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

class Solver {
 public:
  Solver(int rows, int columns, std::span<const GatedPair> pairs)
      : first_(static_cast<std::size_t>(rows) + 1, 0),
        column_of_row_(static_cast<std::size_t>(rows), kNoIndex),
        row_of_column_(static_cast<std::size_t>(columns), kNoIndex),
        row_price_(static_cast<std::size_t>(rows), 0),
        column_price_(static_cast<std::size_t>(columns), 0),
        distance_(static_cast<std::size_t>(columns), infinite),
        from_(static_cast<std::size_t>(columns), kNoIndex),
        done_(static_cast<std::size_t>(columns), 0) {
    for (const GatedPair& pair : pairs) {
      if (pair.gain > 0) edges_.push_back(pair);
    }
    std::sort(edges_.begin(), edges_.end(),
              [](const GatedPair& a, const GatedPair& b) { return std::pair(a.row, a.column) < std::pair(b.row, b.column); });
    for (const GatedPair& edge : edges_) ++first_[edge.row + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  }

  std::vector<int> solve() && {
    for (int row = 0; row + 1 < static_cast<int>(first_.size()); ++row) augment(row);
    return std::move(column_of_row_);
  }

 private:
  using Reached = std::pair<double, int>;  // distance, column

  /// Reduced costs −gain − row price − column price are ≥ 0 for every pair, 0 for the chosen; so is staying alone, 0 − row price,
  /// which ends a path. The new row's price is not yet right: its distances begin from 0 and may be negative, once.
  void augment(int root) {
    touched_.clear();
    queue_ = {};
    row_price_[root] = 0;
    relax(root, 0);
    double best = 0;  // the root stays alone
    int end_row = root, end_column = kNoIndex;
    while (!queue_.empty() && queue_.top().first < best) {
      const auto [distance, column] = queue_.top();
      queue_.pop();
      if (done_[column] || distance > distance_[column]) continue;
      done_[column] = 1;
      const int row = row_of_column_[column];
      if (row == kNoIndex) {
        best = distance;
        end_column = column;
        end_row = kNoIndex;
        break;
      }
      if (distance - row_price_[row] < best) {
        best = distance - row_price_[row];
        end_row = row;
        end_column = kNoIndex;
      }
      relax(row, distance);
    }
    update_prices(root, best);
    flip(root, end_row, end_column);
    for (const int column : touched_) {
      distance_[column] = infinite;
      done_[column] = 0;
    }
  }

  void relax(int row, double base) {
    for (int e = first_[row]; e < first_[row + 1]; ++e) {
      const int column = edges_[e].column;
      const double distance = base - edges_[e].gain - row_price_[row] - column_price_[column];
      if (done_[column] || distance >= distance_[column]) continue;
      if (distance_[column] == infinite) touched_.push_back(column);
      distance_[column] = distance;
      from_[column] = row;
      queue_.push({distance, column});
    }
  }

  void update_prices(int root, double best) {
    row_price_[root] = best;
    for (const int column : touched_) {
      if (!done_[column] || distance_[column] >= best) continue;
      const double change = best - distance_[column];
      column_price_[column] -= change;
      if (row_of_column_[column] != kNoIndex) row_price_[row_of_column_[column]] += change;
    }
  }

  /// The path from the root ends in a free column, or in a row that gives its column up.
  void flip(int root, int end_row, int end_column) {
    if (end_row == root) return;
    int column = end_column;
    if (end_row != kNoIndex) {
      column = column_of_row_[end_row];
      column_of_row_[end_row] = kNoIndex;
    }
    for (;;) {
      const int row = from_[column];
      row_of_column_[column] = row;
      std::swap(column_of_row_[row], column);
      if (row == root) return;
    }
  }

  std::vector<GatedPair> edges_;  // by row
  std::vector<int> first_;        // of each row's edges
  std::vector<int> column_of_row_, row_of_column_;
  std::vector<double> row_price_, column_price_;
  std::vector<double> distance_;
  std::vector<int> from_;
  std::vector<char> done_;
  std::vector<int> touched_;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue_;
};

}  // namespace

std::vector<int> sparse_assignment(int rows, int columns, std::span<const GatedPair> pairs) {
  return Solver(rows, columns, pairs).solve();
}

}  // namespace marey::assign
