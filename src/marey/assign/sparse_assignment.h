// The assignment of greatest gain where each row may stay alone, for graphs that are large, sparse and hang together: a whole
// recording's tracklets, each of which could be followed by some dozens of others. (gated_assignment.h is for many small
// components.)
//
// Rows are taken one after the other, each by the shortest augmenting path over reduced costs (Dijkstra), which ends as soon as a
// free column or a row that had better stay alone is reached: a min-cost flow by successive shortest paths. Where neighbouring rows
// have neighbouring columns the search stays local, and the whole costs little more than a scan of the pairs.
// Cost: rows · (pairs + log) at worst. Reference: Ahuja, Magnanti & Orlin, "Network Flows" (1993), §9.7 and §12.4.
#pragma once

#include <span>
#include <vector>

#include "marey/assign/gated_assignment.h"
#include "marey/assign/no_index.h"

namespace marey::assign {

/// For every row its column, or kNoIndex; the sum of gains is the greatest there is. Rows lie in [0, rows), columns in
/// [0, columns), gains are finite; pairs with gain ≤ 0 are never chosen; each pair occurs once.
std::vector<int> sparse_assignment(int rows, int columns, std::span<const GatedPair> pairs);

}  // namespace marey::assign
