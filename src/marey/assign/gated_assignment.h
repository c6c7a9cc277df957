// Assignment where most pairs are out of the question. A gate leaves few pairs; the graph they form falls apart into small
// connected components; each is solved on its own, optimally. With targets spread over the scene the components stay small, so
// that the whole costs little more than listing the pairs.
//
// A row may stay without a column: the gains of the chosen pairs are maximised, not their number. A pair outside the gate costs
// 0 to the dense solver (linear_assignment.h), as no pair does, and means none: gains are positive, so that any choice can be
// completed by such pairs. A component of more than `largest_component` rows or columns, which no gate worth its name leaves, is
// settled greedily, the greatest gain first, so that time and memory stay bounded.
// Cost: pairs · log + Σ rows² · columns over the components. Deterministic: equal gains are settled by index.
#pragma once

#include <span>
#include <vector>

#include "marey/assign/disjoint_sets.h"
#include "marey/assign/linear_assignment.h"

namespace marey::assign {

/// A row that may be given a column, and what that is worth. Pairs with gain ≤ 0 are never chosen. Each pair occurs once.
struct GatedPair {
  int row = 0;
  int column = 0;
  double gain = 0;
};

class GatedAssigner {
 public:
  static constexpr int largest_component = 1000;

  /// For every row its column, or `kNoIndex`; valid until the next call. Rows lie in [0, rows), columns in [0, columns), gains are
  /// finite. Allocates only where a frame is larger than all before.
  std::span<const int> assign(int rows, int columns, std::span<const GatedPair> pairs);

 private:
  void find_components(int rows, int columns, std::span<const GatedPair> pairs);
  void solve_component(std::span<GatedPair> pairs);
  void name_nodes(std::span<const GatedPair> pairs);
  void solve_greedily(std::span<GatedPair> pairs);

  DisjointSets components_;         // of rows, then columns
  std::vector<GatedPair> grouped_;  // pairs ordered by component, row, column
  std::vector<int> column_of_row_;
  std::vector<int> row_names_, column_names_, column_slot_;  // of the component at hand
  std::vector<char> taken_;                                  // columns given greedily
  std::vector<double> costs_;
  LinearAssigner dense_;
};

}  // namespace marey::assign
