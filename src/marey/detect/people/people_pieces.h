// Which regions of one frame's foreground may be pieces of one body.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "marey/assign/disjoint_sets.h"
#include "marey/core/detection.h"
#include "marey/detect/silhouette.h"

namespace marey::detect::people {

inline constexpr int kManyRegions = 400;  ///< this many are rain and noise, and are not joined

/// The room between two intervals; 0 where they meet.
inline double gap(double begin_a, double end_a, double begin_b, double end_b) {
  return std::max({0.0, begin_b - end_a, begin_a - end_b});
}

/// Whatever the size of people: regions between which there is little room, next to the larger one, are pieces of one thing.
assign::DisjointSets pieces_by_their_own_size(const std::vector<Region>& regions);

/// The same, and what lies within the box of one person who is expected is that person's.
assign::DisjointSets pieces_of_those_expected(const std::vector<Region>& regions, std::span<const Expected> expected);

/// Row by row, in a row from the left.
void put_in_order(std::vector<PixelRun>& runs);

/// Regions that were taken together.
struct Body {
  std::vector<PixelRun> runs;  ///< in order
  Box box;
  double area = 0;
};
std::vector<Body> bodies_of(const std::vector<Region>& regions, assign::DisjointSets& pieces);

}  // namespace marey::detect::people
