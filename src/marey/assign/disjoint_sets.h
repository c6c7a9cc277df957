#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace marey::assign {

/// Which of the elements 0 … n − 1 hang together, by union and find: the clusters of a graph whose edges are told one by one, in
/// any order. A set is named by its lowest element, so that names do not depend on the order of the edges.
class DisjointSets {
 public:
  /// `count` elements, each alone. Allocates only where there are more than ever before.
  void reset(int count) {
    parent_.resize(count);
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int count() const { return static_cast<int>(parent_.size()); }

  /// The name of the set that `element` is in.
  int find(int element) {
    while (parent_[element] != element) {
      parent_[element] = parent_[parent_[element]];
      element = parent_[element];
    }
    return element;
  }

  void join(int a, int b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

}  // namespace marey::assign
