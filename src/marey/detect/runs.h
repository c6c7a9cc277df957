#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "marey/assign/disjoint_sets.h"
#include "marey/detect/silhouette.h"

namespace marey::detect {

/// Appends the runs of non-zero pixels of one row.
void append_runs(const std::uint8_t* pixels, int row, int width, std::vector<PixelRun>& runs);

/// Joins every two runs of neighbouring rows that overlap when one is widened by `reach` columns: 0 joins by edges, 1 by
/// corners too. `runs` are in order.
void join_neighbours(std::span<const PixelRun> runs, int reach, assign::DisjointSets& sets);

}  // namespace marey::detect
