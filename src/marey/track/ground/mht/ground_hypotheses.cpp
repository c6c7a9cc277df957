#include "marey/track/ground/mht/ground_hypotheses.h"

#include <cmath>
#include <numeric>
#include <tuple>

namespace marey::track::ground::mht {

std::span<const GroundHypotheses::Child> GroundHypotheses::branch(std::span<const assign::GatedPair> pairs,
                                                                  std::span<const double> missed, std::span<const char> begins) {
  find_groups(pairs, static_cast<int>(begins.size()));
  children_.clear();
  child_tree_.clear();
  missed_child_.assign(tree_.size(), assign::kNoIndex);
  pair_child_.assign(pairs.size(), assign::kNoIndex);
  initiated_child_.assign(begins.size(), assign::kNoIndex);
  next_clusters_.clear();
  for (const Group& group : groups_) {
    Cluster parents = combine(group.clusters);
    if (group.observations.empty()) {
      miss_all(parents, missed);
      next_clusters_.push_back(std::move(parents));
    } else {
      spawn(parents, group.observations, pairs, missed, begins);
    }
  }
  std::swap(clusters_, next_clusters_);
  std::swap(tree_, child_tree_);
  return children_;
}

/// What gates tie together: clusters, and the observations in the gates of any of their leaves.
void GroundHypotheses::find_groups(std::span<const assign::GatedPair> pairs, int observations) {
  const int clusters = static_cast<int>(clusters_.size());
  cluster_of_.assign(tree_.size(), assign::kNoIndex);
  for (int i = 0; i < clusters; ++i) {
    for (const Hypothesis& hypothesis : clusters_[i]) {
      for (const int leaf : hypothesis.leaves) cluster_of_[leaf] = i;
    }
  }
  first_pair_.assign(tree_.size() + 1, 0);
  sets_.reset(clusters + observations);
  for (const assign::GatedPair& pair : pairs) {
    ++first_pair_[pair.row + 1];
    const int cluster = cluster_of_[pair.row];  // none where every hypothesis that held the leaf was pruned
    if (cluster != assign::kNoIndex) sets_.join(cluster, clusters + pair.column);
  }
  std::partial_sum(first_pair_.begin(), first_pair_.end(), first_pair_.begin());
  elements_.clear();
  for (int i = 0; i < clusters + observations; ++i) elements_.emplace_back(sets_.find(i), i);
  std::sort(elements_.begin(), elements_.end());
  groups_.clear();
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    const auto& [root, element] = elements_[i];
    if (i == 0 || elements_[i - 1].first != root) groups_.emplace_back();
    if (element < clusters) {
      groups_.back().clusters.push_back(element);
    } else {
      groups_.back().observations.push_back(element - clusters);
    }
  }
}

/// One cluster of several: every hypothesis of the one with every hypothesis of the others, the likeliest of these.
GroundHypotheses::Cluster GroundHypotheses::combine(std::span<const int> clusters) {
  Cluster together{{0, {}}};
  bool first = true;
  for (const int i : clusters) {
    together = first ? std::move(clusters_[i]) : product(together, clusters_[i]);
    first = false;
  }
  if (clusters.size() > 1) {
    for (Hypothesis& hypothesis : together) sort_by_tree(hypothesis.leaves);
  }
  return together;
}

GroundHypotheses::Cluster GroundHypotheses::product(const Cluster& a, const Cluster& b) const {
  const double minimum = a.front().weight + b.front().weight - limits_.log_ratio;
  std::vector<std::tuple<double, int, int>> sums;
  for (int i = 0; i < static_cast<int>(a.size()); ++i) {
    for (int j = 0; j < static_cast<int>(b.size()); ++j) {
      const double sum = a[i].weight + b[j].weight;
      if (sum >= minimum) sums.emplace_back(-sum, i, j);
    }
  }
  std::sort(sums.begin(), sums.end());
  const int maximum = kept(a.front().leaves.size() + b.front().leaves.size());
  if (static_cast<int>(sums.size()) > maximum) sums.resize(maximum);
  Cluster together;
  for (const auto& [negative, i, j] : sums) {
    Hypothesis& one = together.emplace_back(a[i]);
    one.weight = -negative;
    one.leaves.insert(one.leaves.end(), b[j].leaves.begin(), b[j].leaves.end());
  }
  return together;
}

void GroundHypotheses::miss_all(Cluster& cluster, std::span<const double> missed) {
  for (Hypothesis& hypothesis : cluster) {
    for (int& leaf : hypothesis.leaves) {
      hypothesis.weight += missed[leaf];
      leaf = child(leaf, assign::kNoIndex, missed_child_[leaf]);
    }
  }
  settle(cluster);
}

/// The number of the child in `slot`, which is made where it does not stand yet.
int GroundHypotheses::child(int leaf, int observation, int& slot) {
  if (slot == assign::kNoIndex) {
    slot = static_cast<int>(children_.size());
    children_.push_back({leaf, observation});
    child_tree_.push_back(leaf == assign::kNoIndex ? next_tree_++ : tree_[leaf]);
  }
  return slot;
}

/// The assignment problems of a cluster, one for each hypothesis. Rows are the leaves that have anything in their gates.
void GroundHypotheses::pose(const Cluster& parents, std::span<const assign::GatedPair> pairs, std::span<const double> missed,
                            int columns) {
  posed_.clear();
  problems_.clear();
  posed_at_.assign(1, 0);
  for (const Hypothesis& parent : parents) {
    assign::AssignmentProblem problem{.rows = 0, .columns = columns, .gain = parent.weight};
    for (const int leaf : parent.leaves) {
      problem.gain += missed[leaf];
      const int first = first_pair_[leaf];
      const int last = first_pair_[leaf + 1];
      for (int i = first; i < last; ++i)
        posed_.push_back({problem.rows, column_of_[pairs[i].column], pairs[i].gain - missed[leaf]});
      if (first < last) ++problem.rows;
    }
    problems_.push_back(problem);
    posed_at_.push_back(posed_.size());
  }
  for (std::size_t i = 0; i < problems_.size(); ++i) {
    problems_[i].pairs = std::span(posed_).subspan(posed_at_[i], posed_at_[i + 1] - posed_at_[i]);
  }
}

void GroundHypotheses::spawn(const Cluster& parents, std::span<const int> observations, std::span<const assign::GatedPair> pairs,
                             std::span<const double> missed, std::span<const char> begins) {
  const int columns = static_cast<int>(observations.size());
  column_of_.resize(std::max(column_of_.size(), begins.size()));
  for (int i = 0; i < columns; ++i) column_of_[observations[i]] = i;
  pose(parents, pairs, missed, columns);
  const auto answers = assigner_.find(problems_, kept(parents.front().leaves.size()), limits_.log_ratio);
  // Trees are numbered before hypotheses are formed, so that leaves stand by tree in each.
  taken_.assign(answers.size() * columns, 0);
  for (std::size_t a = 0; a < answers.size(); ++a) {
    for (const int column : answers[a].column_of_row) {
      if (column != assign::kNoIndex) taken_[a * columns + column] = 1;
    }
  }
  for (int column = 0; column < columns; ++column) {
    bool unexplained = false;
    for (std::size_t a = 0; a < answers.size(); ++a) unexplained = unexplained || !taken_[a * columns + column];
    if (unexplained && begins[observations[column]])
      child(assign::kNoIndex, observations[column], initiated_child_[observations[column]]);
  }
  Cluster cluster;
  bool anybody = false;
  for (std::size_t a = 0; a < answers.size(); ++a) {
    Hypothesis& one = cluster.emplace_back();
    one.weight = answers[a].gain;
    int row = 0;
    for (const int leaf : parents[answers[a].problem].leaves) {
      const int first = first_pair_[leaf];
      const int column = first < first_pair_[leaf + 1] ? answers[a].column_of_row[row++] : assign::kNoIndex;
      int pair = first;
      while (column != assign::kNoIndex && pairs[pair].column != observations[column]) ++pair;
      one.leaves.push_back(column == assign::kNoIndex ? child(leaf, assign::kNoIndex, missed_child_[leaf])
                                                      : child(leaf, observations[column], pair_child_[pair]));
    }
    for (int column = 0; column < columns; ++column) {
      const int initiated = initiated_child_[observations[column]];
      if (initiated != assign::kNoIndex && !taken_[a * columns + column]) one.leaves.push_back(initiated);
    }
    anybody = anybody || !one.leaves.empty();
  }
  settle(cluster);
  if (anybody) next_clusters_.push_back(std::move(cluster));
}

/// How many hypotheses a cluster may have, where each has about this many leaves.
int GroundHypotheses::kept(std::size_t leaves) const {
  const int affordable = limits_.leaves / std::max(1, static_cast<int>(leaves));
  return std::clamp(affordable, 1, limits_.hypotheses);
}

/// The best first, of weight 0; those that are too unlikely, or too many, are dropped.
void GroundHypotheses::settle(Cluster& cluster) const {
  std::sort(cluster.begin(), cluster.end(), [](const Hypothesis& a, const Hypothesis& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.leaves < b.leaves;
  });
  const double best = cluster.front().weight;
  std::size_t count = 0;
  const auto maximum = static_cast<std::size_t>(kept(cluster.front().leaves.size()));
  while (count < cluster.size() && count < maximum && cluster[count].weight >= best - limits_.log_ratio) ++count;
  cluster.resize(count);
  for (Hypothesis& hypothesis : cluster) hypothesis.weight -= best;
}

void GroundHypotheses::sort_by_tree(std::vector<int>& leaves) const {
  std::sort(leaves.begin(), leaves.end(), [this](int a, int b) { return tree_[a] < tree_[b]; });
}

void GroundHypotheses::decide(std::span<const int> past) {
  const auto agrees = [&](const Hypothesis& best, const Hypothesis& other) {
    auto a = best.leaves.begin();
    auto b = other.leaves.begin();
    while (a != best.leaves.end() || b != other.leaves.end()) {
      const bool has_a = a != best.leaves.end() && (b == other.leaves.end() || tree_[*a] <= tree_[*b]);
      const bool has_b = b != other.leaves.end() && (a == best.leaves.end() || tree_[*b] <= tree_[*a]);
      if ((has_a ? past[*a] : assign::kNoIndex) != (has_b ? past[*b] : assign::kNoIndex)) return false;
      if (has_a) ++a;
      if (has_b) ++b;
    }
    return true;
  };
  for (Cluster& cluster : clusters_) {
    const auto contradicts = [&](const Hypothesis& other) { return !agrees(cluster.front(), other); };
    cluster.erase(std::remove_if(cluster.begin() + 1, cluster.end(), contradicts), cluster.end());
  }
}

void GroundHypotheses::drop(std::span<const char> gone) {
  std::erase_if(clusters_, [&](Cluster& cluster) {
    bool anybody = false;
    for (Hypothesis& hypothesis : cluster) {
      std::erase_if(hypothesis.leaves, [&](int leaf) { return gone[leaf] != 0; });
      anybody = anybody || !hypothesis.leaves.empty();
    }
    return !anybody;
  });
}

std::vector<int> GroundHypotheses::trees_of(const Cluster& cluster, const std::vector<int>& tree) {
  std::vector<int> trees;
  for (const Hypothesis& hypothesis : cluster) {
    for (const int leaf : hypothesis.leaves) trees.push_back(tree[leaf]);
  }
  std::sort(trees.begin(), trees.end());
  trees.erase(std::unique(trees.begin(), trees.end()), trees.end());
  return trees;
}

/// A part for each set of `joined`, whose elements are places in `trees`. What hypotheses say of a part is weighed by all that say
/// so.
void GroundHypotheses::take_apart(const Cluster& cluster, std::span<const int> trees, assign::DisjointSets& joined,
                                  std::vector<Cluster>& parts) const {
  for (int root = 0; root < static_cast<int>(trees.size()); ++root) {
    if (joined.find(root) != root) continue;
    Cluster part;
    for (const Hypothesis& hypothesis : cluster) {
      Hypothesis fraction{hypothesis.weight, {}};
      for (const int leaf : hypothesis.leaves) {
        const auto location = std::lower_bound(trees.begin(), trees.end(), tree_[leaf]) - trees.begin();
        if (joined.find(static_cast<int>(location)) == root) fraction.leaves.push_back(leaf);
      }
      const auto same =
          std::find_if(part.begin(), part.end(), [&](const Hypothesis& one) { return one.leaves == fraction.leaves; });
      if (same == part.end()) {
        part.push_back(std::move(fraction));
      } else {
        same->weight += std::log1p(std::exp(fraction.weight - same->weight));
      }
    }
    settle(part);
    parts.push_back(std::move(part));
  }
}

std::span<const int> GroundHypotheses::compact() {
  number_.assign(tree_.size(), assign::kNoIndex);
  order_.clear();
  for (Cluster& cluster : clusters_) {
    for (Hypothesis& hypothesis : cluster) {
      for (int& leaf : hypothesis.leaves) {
        if (number_[leaf] == assign::kNoIndex) {
          number_[leaf] = static_cast<int>(order_.size());
          order_.push_back(leaf);
        }
        leaf = number_[leaf];
      }
    }
  }
  child_tree_.clear();
  for (const int leaf : order_) child_tree_.push_back(tree_[leaf]);
  std::swap(tree_, child_tree_);
  return order_;
}

std::span<const int> GroundHypotheses::best() {
  order_.clear();
  for (const Cluster& cluster : clusters_)
    order_.insert(order_.end(), cluster.front().leaves.begin(), cluster.front().leaves.end());
  sort_by_tree(order_);
  return order_;
}

}  // namespace marey::track::ground::mht
