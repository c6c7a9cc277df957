// The global hypotheses of multiple-hypothesis tracking, kept cluster by cluster. They know nothing of motion: a leaf is a number
// that stands for one target with one history (ground_mht.h keeps its state), and a hypothesis is a set of leaves with a weight.
//
// Reid, "An algorithm for tracking multiple targets", IEEE Trans. AC 24 (1979); Cox & Hingorani, "An efficient implementation of
// Reid's multiple hypothesis tracking algorithm", PAMI 18 (1996). Targets whose gates touch within a view form a cluster;
// clusters are independent, so that 2^n hypotheses over all targets are a few over each cluster. A view turns each hypothesis of a
// cluster into children, of which the best over all parents are found in order by Murty's method, and no others are ever formed.
// Hypotheses share leaves: all that give a leaf the same observation have the same child of it. Clusters merge where an
// observation lies in gates of both, and split where their targets share no observation any longer.
// Cost a view and cluster: about hypotheses · (targets + pairs), and one shortest path for each hypothesis kept.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "marey/assign/disjoint_sets.h"
#include "marey/assign/k_best_assignments.h"

namespace marey::track::ground::mht {

class GroundHypotheses {
 public:
  struct Limits {
    int hypotheses = 50;     ///< of a cluster, at most
    int leaves = 2000;       ///< of all hypotheses of a cluster together, counted once for each: in large ones fewer are kept
    double log_ratio = 9.2;  ///< a hypothesis less likely than the best by more than this is dropped
  };

  struct Hypothesis {
    double weight = 0;        ///< logarithm, up to a constant of the cluster
    std::vector<int> leaves;  ///< by tree, one of each at most
  };
  /// The best hypothesis first; never without one.
  using Cluster = std::vector<Hypothesis>;

  /// How a leaf continues after a view: leaf i of after the view is `leaf` of before it, given `observation`. Where `leaf` is not
  /// one the observation begins a tree; where `observation` is not one the leaf was given nothing.
  struct Child {
    int leaf = assign::kNoIndex;
    int observation = assign::kNoIndex;
  };

  explicit GroundHypotheses(const Limits& limits) : limits_(limits) {}

  /// Takes in a view. `pairs`: leaf, observation and the logarithm of how much likelier that is than that nothing known caused the
  /// observation; by leaf, then by observation. `missed`: of each leaf, the logarithm of the probability that it is given nothing.
  /// `begins`: of each observation, whether a tree begins where nothing else explains it. Renumbers all leaves. Valid until the
  /// next call.
  std::span<const Child> branch(std::span<const assign::GatedPair> pairs, std::span<const double> missed,
                                std::span<const char> begins);

  /// Makes one of hypotheses that differ in nothing that matters any longer: those with the same trees, whose leaves `alike(a, b)`
  /// calls the same. The likelier one stays and takes over the other's weight, so that of many explanations of a scuffle the one
  /// memory is left of which target came out of it where.
  template <typename Alike>
  void fold(Alike&& alike);

  /// Keeps of each cluster the hypotheses whose trees have the same past as the best's: `past` numbers each leaf's.
  void decide(std::span<const int> past);

  /// Takes omits of all hypotheses.
  void drop(std::span<const char> gone);

  /// Splits clusters. `for_each_key(leaf, visit)` calls visit(key) for each observation, however named, that is in the leaf's
  /// history and not decided; trees without one in common, of any of their leaves, need not be in one cluster.
  template <typename ForEachKey>
  void split(ForEachKey&& for_each_key);

  /// Renumbers the leaves, omitting those that no hypothesis has; the numbers that those which stay had before, in order. Valid
  /// until the next call.
  std::span<const int> compact();

  const std::vector<Cluster>& clusters() const { return clusters_; }
  int leaves() const { return static_cast<int>(tree_.size()); }

  /// The tree of a leaf: 1, 2, … in the order in which trees began.
  int tree(int leaf) const { return tree_[leaf]; }

  /// The leaves of all best hypotheses, by tree. Valid until the next call.
  std::span<const int> best();

 private:
  struct Group {
    std::vector<int> clusters, observations;
  };
  void find_groups(std::span<const assign::GatedPair> pairs, int observations);
  Cluster combine(std::span<const int> clusters);
  Cluster product(const Cluster& a, const Cluster& b) const;
  void spawn(const Cluster& parents, std::span<const int> observations, std::span<const assign::GatedPair> pairs,
             std::span<const double> missed, std::span<const char> begins);
  void pose(const Cluster& parents, std::span<const assign::GatedPair> pairs, std::span<const double> missed, int columns);
  void miss_all(Cluster& cluster, std::span<const double> missed);
  int child(int leaf, int observation, int& slot);
  int kept(std::size_t leaves) const;
  void settle(Cluster& cluster) const;
  void sort_by_tree(std::vector<int>& leaves) const;
  void take_apart(const Cluster& cluster, std::span<const int> trees, assign::DisjointSets& joined,
                  std::vector<Cluster>& parts) const;
  static std::vector<int> trees_of(const Cluster& cluster, const std::vector<int>& tree);

  Limits limits_;
  std::vector<Cluster> clusters_;
  std::vector<int> tree_;  // of each leaf
  int next_tree_ = 1;
  assign::KBestAssigner assigner_;
  // What a view needs.
  assign::DisjointSets sets_;
  std::vector<int> cluster_of_, first_pair_;
  std::vector<std::pair<int, int>> elements_;
  std::vector<Group> groups_;
  std::vector<Cluster> next_clusters_;
  std::vector<Child> children_;
  std::vector<int> child_tree_, missed_child_, pair_child_, initiated_child_, column_of_, row_pairs_;
  std::vector<assign::GatedPair> posed_;
  std::vector<std::size_t> posed_at_;
  std::vector<assign::AssignmentProblem> problems_;
  std::vector<char> taken_;
  std::vector<int> order_, number_;
  std::vector<std::pair<std::int64_t, int>> fractions_;
};

template <typename Alike>
void GroundHypotheses::fold(Alike&& alike) {
  const auto same = [&](const Hypothesis& a, const Hypothesis& b) {
    if (a.leaves.size() != b.leaves.size()) return false;
    for (std::size_t i = 0; i < a.leaves.size(); ++i) {
      if (a.leaves[i] == b.leaves[i]) continue;
      if (tree_[a.leaves[i]] != tree_[b.leaves[i]] || !alike(a.leaves[i], b.leaves[i])) return false;
    }
    return true;
  };
  for (Cluster& cluster : clusters_) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < cluster.size(); ++i) {
      std::size_t into = 0;
      while (into < kept && !same(cluster[into], cluster[i])) ++into;
      if (into < kept) {
        cluster[into].weight += std::log1p(std::exp(cluster[i].weight - cluster[into].weight));
      } else {
        if (kept != i) std::swap(cluster[kept], cluster[i]);
        ++kept;
      }
    }
    cluster.resize(kept);
    settle(cluster);
  }
}

template <typename ForEachKey>
void GroundHypotheses::split(ForEachKey&& for_each_key) {
  std::vector<Cluster> parts;
  for (Cluster& cluster : clusters_) {
    const std::vector<int> trees = trees_of(cluster, tree_);
    if (trees.size() <= 1) {
      parts.push_back(std::move(cluster));
      continue;
    }
    const auto location = [&](int leaf) {
      return static_cast<int>(std::lower_bound(trees.begin(), trees.end(), tree_[leaf]) - trees.begin());
    };
    sets_.reset(static_cast<int>(trees.size()));
    if (cluster.size() > 1) {
      fractions_.clear();
      order_.clear();
      for (const Hypothesis& hypothesis : cluster) {
        for (const int leaf : hypothesis.leaves) order_.push_back(leaf);
      }
      std::sort(order_.begin(), order_.end());
      order_.erase(std::unique(order_.begin(), order_.end()), order_.end());
      for (const int leaf : order_) for_each_key(leaf, [&](std::int64_t key) { fractions_.emplace_back(key, location(leaf)); });
      std::sort(fractions_.begin(), fractions_.end());
      for (std::size_t i = 1; i < fractions_.size(); ++i) {
        if (fractions_[i].first == fractions_[i - 1].first) sets_.join(fractions_[i].second, fractions_[i - 1].second);
      }
    }
    take_apart(cluster, trees, sets_, parts);
  }
  clusters_ = std::move(parts);
}

}  // namespace marey::track::ground::mht
