// Who is whom, where most pairs are out of the question. A gate leaves few pairs; the graph they form falls apart into small
// connected components; each is solved on its own, optimally. With targets spread over the scene the components stay small, so
// that the whole costs little more than listing the pairs.
//
// A row may stay without a column: the gains of the chosen pairs are maximised, not their number. A component is solved by
// shortest augmenting paths (Jonker & Volgenant 1987), its missing pairs and "nobody" being columns of gain 0.
// Cost: pairs · log + Σ rows² · columns over the components. Deterministic: equal gains are settled by index.
#pragma once

#include <span>
#include <vector>

namespace marey {

/// A row that may be given a column, and what that is worth. Pairs with gain ≤ 0 are never chosen. Each pair occurs once.
struct GatedPair {
  int row = 0;
  int column = 0;
  double gain = 0;
};

class GatedAssigner {
 public:
  static constexpr int nobody = -1;

  /// For every row its column, or `nobody`; valid until the next call. Rows lie in [0, rows), columns in [0, columns), gains are
  /// finite. Allocates only where a frame is larger than all before.
  std::span<const int> assign(int rows, int columns, std::span<const GatedPair> pairs);

 private:
  int root_of(int node);
  void find_components(int rows, int columns, std::span<const GatedPair> pairs);
  void solve_component(std::span<const GatedPair> pairs);
  void augment(int row, int columns);

  std::vector<int> parent_;         // union-find over rows, then columns
  std::vector<GatedPair> grouped_;  // pairs ordered by component, row, column
  std::vector<int> column_of_row_;
  std::vector<int> row_names_, column_names_, column_slot_;  // of the component at hand
  std::vector<double> cost_, row_price_, column_price_, shortest_;
  std::vector<int> row_of_column_, from_column_;
  std::vector<char> done_;
};

}  // namespace marey
