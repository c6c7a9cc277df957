// The rectangular assignment problem: pairs of rows and columns, min(rows, columns) of them, of least total cost. Shortest
// augmenting paths (Jonker & Volgenant 1987) in the form of D. F. Crouse, "On implementing 2D rectangular assignment
// algorithms", IEEE Trans. AES 52 (2016): one Dijkstra a row over reduced costs.
//
// Where several assignments cost the same, the choice is the one that SciPy's linear_sum_assignment makes (columns are inspected
// in the same order, a free column wins a draw, and a matrix with more rows than columns is transposed): evaluation, whose
// figures can hang on such draws, then agrees with the reference implementations.
// Cost: O(rows² · columns) at worst; a fraction of that where most rows have an obvious column. For sparse problems see
// gated_assignment.h.
#pragma once

#include <span>
#include <vector>

#include "marey/assign/no_index.h"

namespace marey::assign {

class LinearAssigner {
 public:
  /// For every row its column, or `kNoIndex` where there are more rows than columns; valid until the next call. `costs` is
  /// row-major, rows × columns, all finite. Allocates only where a problem is larger than all before.
  std::span<const int> assign(int rows, int columns, std::span<const double> costs);

 private:
  void solve(int rows, int columns, const double* costs);
  int find_path(int row, int columns, const double* costs);

  std::vector<double> transposed_, row_price_, column_price_, shortest_;
  std::vector<int> column_of_row_, row_of_column_, from_row_, remaining_, result_;
  std::vector<char> row_observed_, column_observed_;
  double path_cost_ = 0;
};

}  // namespace marey::assign
