#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "marey/detect/silhouette.h"

namespace marey::detect {

/// Union-find over 0 … size − 1. A set's root is its smallest member.
class Forest {
 public:
  explicit Forest(std::size_t size = 0) { reset(size); }

  void reset(std::size_t size) {
    parent_.resize(size);
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int root(int node) {
    while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
    return node;
  }

  void join(int a, int b) {
    a = root(a);
    b = root(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

/// Appends the runs of non-zero pixels of one row.
void append_runs(const std::uint8_t* pixels, int row, int width, std::vector<PixelRun>& runs);

/// Joins every two runs of neighbouring rows that overlap when one is widened by `reach` columns: 0 joins by edges, 1 by
/// corners too. `runs` are in order.
void join_neighbours(std::span<const PixelRun> runs, int reach, Forest& forest);

}  // namespace marey::detect
