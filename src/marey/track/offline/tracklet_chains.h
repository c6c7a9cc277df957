// Which tracklets follow which: what the second pass in an image and the one on the ground have in common. Each of them says what
// it is worth that the piece which begins is the one which has ended; here are the pairs that come into question by time, and the
// chains that one assignment of ends to beginnings (assign/sparse_assignment.h) makes of the pieces.
// Cost: sorting the beginnings, and the pairs within the longest gap.
#pragma once

#include <algorithm>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace marey::track::offline {

/// Calls `visit(tail, head)` with the indices of every end and every beginning that comes after it by at most `longest`: ends in
/// order, for each its beginnings in the order of time, then of index. Ends and beginnings have a `time`.
template <typename Ends, typename Gap, typename Visit>
void for_each_successor(const Ends& tails, const Ends& heads, Gap longest, Visit&& visit) {
  std::vector<int> by_time(std::size(heads));
  std::iota(by_time.begin(), by_time.end(), 0);
  std::sort(by_time.begin(), by_time.end(),
            [&](int a, int b) { return std::pair(heads[a].time, a) < std::pair(heads[b].time, b); });
  for (int tail = 0; tail < static_cast<int>(std::size(tails)); ++tail) {
    const auto now = tails[tail].time;
    auto next = std::upper_bound(by_time.begin(), by_time.end(), now, [&](auto time, int head) { return time < heads[head].time; });
    for (; next != by_time.end() && heads[*next].time - now <= longest; ++next) visit(tail, *next);
  }
}

/// The chains of pieces of which each is followed by `next` of it, or by none (assign::kNoIndex): each piece in one of them, chains
/// in the order of the indices of their first. No piece follows two, nor itself after whatever others.
std::vector<std::vector<int>> chains_of(std::span<const int> next);

}  // namespace marey::track::offline
