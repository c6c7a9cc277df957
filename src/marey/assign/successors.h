// The one linker of pieces of tracks: which piece follows which. Pieces of paths in an image, of people on a ground and of markers
// are linked by it; each of them says what it is worth that the piece which begins is the one that has ended (or how far the two
// are off each other), and no more. Here are the pairs that come into question by time, what is decided among them, and the chains
// that result.
//
// Decided by one assignment of ends to beginnings (sparse_assignment.h) that maximises the sum of gains; or, where a wrong link
// costs more than a missing one, by taking those pairs alone that are each other's best by far. Cost: sorting the beginnings, and
// the pairs within the longest gap.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "marey/assign/gated_assignment.h"
#include "marey/assign/no_index.h"

namespace marey::assign {

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

/// The pairs of an end and a beginning within `longest` that gain more than `least`; `gain(tail, head)` is a number, or nothing
/// where it is out of the question.
template <typename Ends, typename Gap, typename Gain>
std::vector<GatedPair> successor_pairs(const Ends& tails, const Ends& heads, Gap longest, Gain&& gain, double minimum = 0) {
  std::vector<GatedPair> pairs;
  for_each_successor(tails, heads, longest, [&](int tail, int head) {
    const std::optional<double> value = gain(tail, head);
    if (value && *value > minimum) pairs.push_back({tail, head, *value});
  });
  return pairs;
}

/// For each of this many pieces the one that follows it, or kNoIndex: the sum of the pairs' gains is the greatest. No piece follows
/// two. Pairs that gain nothing are omitted.
std::vector<int> best_successors(int pieces, std::span<const GatedPair> pairs);

/// When a pair is beyond doubt, in units of what an end and its continuation may be off.
struct ClearPair {
  double max_off = 1;          ///< of the pair
  double clearer = 2.5;        ///< times as far off any other that either of both may be paired with must be,
  double min_clearance = 0.4;  ///< and so far at least
};

/// For each end the beginning that follows it, or kNoIndex: pairs within `longest` that are beyond doubt alone. `off(tail, head)` ≥
/// 0.
template <typename Ends, typename Gap, typename Off>
std::vector<int> clear_successors(const Ends& tails, const Ends& heads, Gap longest, Off&& off, const ClearPair& limits = {}) {
  struct Best {
    int other = kNoIndex;
    double off = std::numeric_limits<double>::max(), next = std::numeric_limits<double>::max();
    void offer(int candidate, double its) {
      if (its < off) {
        next = off, off = its, other = candidate;
      } else {
        next = std::min(next, its);
      }
    }
  };
  std::vector<Best> before(std::size(heads)), after(std::size(tails));
  for_each_successor(tails, heads, longest, [&](int tail, int head) {
    const double its = off(tail, head);
    before[static_cast<std::size_t>(head)].offer(tail, its);
    after[static_cast<std::size_t>(tail)].offer(head, its);
  });
  std::vector<int> next(std::size(tails), kNoIndex);
  for (std::size_t tail = 0; tail < next.size(); ++tail) {
    const Best& best = after[tail];
    if (best.other == kNoIndex || best.off > limits.max_off) continue;
    const Best& back = before[static_cast<std::size_t>(best.other)];
    const double clear = std::max(limits.clearer * best.off, limits.min_clearance);
    if (back.other == static_cast<int>(tail) && best.next > clear && back.next > clear) next[tail] = best.other;
  }
  return next;
}

/// The chains of pieces of which each is followed by `next` of it, or by none (kNoIndex): each piece in one of them, chains in the
/// order of the indices of their first. No piece follows two, nor itself after whatever others.
std::vector<std::vector<int>> chains_of(std::span<const int> next);

}  // namespace marey::assign
