#include "marey/assign/association_marginals.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace marey::assign {

std::span<const double> AssociationMarginals::find(int rows, int columns, std::span<const GatedPair> pairs) {
  probability_.assign(pairs.size(), 0);
  clusters_.reset(rows + columns);
  for (const GatedPair& pair : pairs) clusters_.join(pair.row, rows + pair.column);
  order_.resize(pairs.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::sort(order_.begin(), order_.end(), [&](int a, int b) {
    const int first = clusters_.find(pairs[a].row), second = clusters_.find(pairs[b].row);
    if (first != second) return first < second;
    return pairs[a].row != pairs[b].row ? pairs[a].row < pairs[b].row : pairs[a].column < pairs[b].column;
  });
  for (std::size_t from = 0; from < order_.size();) {
    const int cluster = clusters_.find(pairs[order_[from]].row);
    std::size_t to = from;
    while (to < order_.size() && clusters_.find(pairs[order_[to]].row) == cluster) ++to;
    solve_cluster(pairs, std::span(order_).subspan(from, to - from));
    from = to;
  }
  return probability_;
}

void AssociationMarginals::solve_cluster(std::span<const GatedPair> pairs, std::span<const int> members) {
  row_names_.clear();
  column_names_.clear();
  for (const int i : members) {
    if (row_names_.empty() || row_names_.back() != pairs[i].row) row_names_.push_back(pairs[i].row);
    column_names_.push_back(pairs[i].column);
  }
  std::sort(column_names_.begin(), column_names_.end());
  column_names_.erase(std::unique(column_names_.begin(), column_names_.end()), column_names_.end());
  arcs_.clear();
  for (const int i : members) {
    const auto row = std::lower_bound(row_names_.begin(), row_names_.end(), pairs[i].row) - row_names_.begin();
    const auto column = std::lower_bound(column_names_.begin(), column_names_.end(), pairs[i].column) - column_names_.begin();
    arcs_.push_back({static_cast<int>(row), static_cast<int>(column), 0, static_cast<std::size_t>(i)});
  }
  const int rows = static_cast<int>(row_names_.size()), columns = static_cast<int>(column_names_.size());
  if (columns <= max_columns)
    sum_exactly(pairs, rows, columns);
  else
    sum_best(pairs, rows, columns);
}

/// Weights are scaled row by row, so that the greatest is 1: products of many stay finite.
void AssociationMarginals::sum_exactly(std::span<const GatedPair> pairs, int rows, int columns) {
  begin_.assign(static_cast<std::size_t>(rows) + 1, arcs_.size());
  for (std::size_t a = arcs_.size(); a-- > 0;) begin_[arcs_[a].row] = a;
  alone_.resize(rows);
  for (int row = 0; row < rows; ++row) {
    double greatest = 0;
    for (std::size_t a = begin_[row]; a < begin_[row + 1]; ++a) greatest = std::max(greatest, pairs[arcs_[a].pair].gain);
    alone_[row] = std::exp(-greatest);
    for (std::size_t a = begin_[row]; a < begin_[row + 1]; ++a) arcs_[a].weight = std::exp(pairs[arcs_[a].pair].gain - greatest);
  }
  const int sets = 1 << columns;
  sum_backwards(rows, sets);
  forwards_.assign(static_cast<std::size_t>(sets) * 2, 0);
  double* now = forwards_.data();
  double* next = now + sets;
  now[0] = 1;
  for (int row = 0; row < rows; ++row) {
    const double* after = backwards_.data() + static_cast<std::size_t>(row + 1) * sets;
    for (int set = 0; set < sets; ++set) next[set] = alone_[row] * now[set];
    for (std::size_t a = begin_[row]; a < begin_[row + 1]; ++a) {
      const int bit = 1 << arcs_[a].column;
      double sum = 0;
      for (int set = 0; set < sets; ++set) {
        if ((set & bit) != 0 || now[set] == 0) continue;
        const double weight = now[set] * arcs_[a].weight;
        sum += weight * after[set | bit];
        next[set | bit] += weight;
      }
      probability_[arcs_[a].pair] = sum / backwards_[0];
    }
    std::swap(now, next);
  }
}

/// backwards_[row · sets + set]: the weight of all answers of this row and those after it that leave the columns of `set` alone.
void AssociationMarginals::sum_backwards(int rows, int sets) {
  backwards_.resize(static_cast<std::size_t>(rows + 1) * sets);
  std::fill(backwards_.end() - sets, backwards_.end(), 1.0);
  for (int row = rows - 1; row >= 0; --row) {
    double* here = backwards_.data() + static_cast<std::size_t>(row) * sets;
    const double* after = here + sets;
    for (int set = 0; set < sets; ++set) {
      double sum = alone_[row] * after[set];
      for (std::size_t a = begin_[row]; a < begin_[row + 1]; ++a) {
        const int bit = 1 << arcs_[a].column;
        if ((set & bit) == 0) sum += arcs_[a].weight * after[set | bit];
      }
      here[set] = sum;
    }
  }
}

void AssociationMarginals::sum_best(std::span<const GatedPair> pairs, int rows, int columns) {
  named_.clear();
  for (const Arc& arc : arcs_) named_.push_back({arc.row, arc.column, pairs[arc.pair].gain});
  const AssignmentProblem problem{.rows = rows, .columns = columns, .pairs = named_};
  const auto answers = best_.find({&problem, 1}, max_answers);
  double total = 0;
  for (const auto& answer : answers) {
    const double weight = std::exp(answer.gain - answers.front().gain);
    total += weight;
    for (const Arc& arc : arcs_) {
      if (answer.column_of_row[arc.row] == arc.column) probability_[arc.pair] += weight;
    }
  }
  for (const Arc& arc : arcs_) probability_[arc.pair] /= total;
}

}  // namespace marey::assign
