#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace marey::assign {

/// The root of the tree that `element` is in, where `parent_of(i)` is a reference to the parent of i, a root its own. Halves the
/// path as it climbs. For records that hold their own parents; else use DisjointSets.
template <typename ParentOf>
int find_root(int element, ParentOf&& parent_of) {
  while (parent_of(element) != element) {
    parent_of(element) = parent_of(parent_of(element));
    element = parent_of(element);
  }
  return element;
}

/// Joins the trees of two roots under the lower one.
template <typename ParentOf>
void join_roots(int a, int b, ParentOf&& parent_of) {
  parent_of(std::max(a, b)) = std::min(a, b);
}

/// Which of the elements 0 … n − 1 hang together, by union and find: the clusters of a graph whose edges are given one by one, in
/// any order. A set is named by its lowest element, so that names do not depend on the order of the edges.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count = 0) { reset(count); }

  /// `count` elements, each alone. Allocates only where there are more than ever before.
  void reset(std::size_t count) {
    parent_.resize(count);
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int count() const { return static_cast<int>(parent_.size()); }

  /// The name of the set that `element` is in.
  int find(int element) {
    return find_root(element, [this](int i) -> int& { return parent_[i]; });
  }

  void join(int a, int b) {
    join_roots(find(a), find(b), [this](int i) -> int& { return parent_[i]; });
  }

 private:
  std::vector<int> parent_;
};

}  // namespace marey::assign
