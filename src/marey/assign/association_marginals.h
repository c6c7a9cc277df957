// How probable each pair of a row and a column is, over all assignments together: joint probabilistic data association
// (Fortmann, Bar-Shalom & Scheffe 1983). An answer gives each row one column at most and each column to one row at most; its weight
// is the product of its pairs' weights, and a pair's probability is the share of the answers that have it.
//
// Pairs fall apart into clusters that share no column. Within a cluster answers are not listed but summed row by row over the sets
// of columns in use, forwards and backwards, as in a hidden Markov model: exact, and of cost rows · 2^columns · columns instead of
// the number of answers, which is exponential in the rows. A cluster of more than `max_columns`, which only a gate that holds
// half of the scene leaves, is summed over its most probable answers alone (k_best_assignments.h).
#pragma once

#include <span>
#include <vector>

#include "marey/assign/disjoint_sets.h"
#include "marey/assign/gated_assignment.h"
#include "marey/assign/k_best_assignments.h"

namespace marey::assign {

class AssociationMarginals {
 public:
  static constexpr int max_columns = 12;  ///< of a cluster that is summed exactly
  static constexpr int max_answers = 300;

  /// For each pair its probability, in the order of the pairs; valid until the next call. A pair's gain is the logarithm of its
  /// weight against that of its row having no column, of any sign; each pair occurs once.
  std::span<const double> find(int rows, int columns, std::span<const GatedPair> pairs);

 private:
  struct Arc {
    int row = 0, column = 0;  // within the cluster
    double weight = 0;
    std::size_t pair = 0;
  };
  void solve_cluster(std::span<const GatedPair> pairs, std::span<const int> members);
  void sum_exactly(std::span<const GatedPair> pairs, int rows, int columns);
  void sum_backwards(int rows, int sets);
  void sum_best(std::span<const GatedPair> pairs, int rows, int columns);

  DisjointSets clusters_;
  std::vector<int> order_;  // pairs by cluster, then by row
  std::vector<int> row_names_, column_names_;
  std::vector<Arc> arcs_;           // of the cluster at hand, by row
  std::vector<std::size_t> begin_;  // of each row: its first arc
  std::vector<double> alone_;       // of each row: the weight of having no column
  std::vector<double> forwards_, backwards_;
  std::vector<GatedPair> named_;
  std::vector<double> probability_;
  KBestAssigner best_;
};

}  // namespace marey::assign
