#include "marey/assign/successors.h"

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "marey/assign/sparse_assignment.h"

namespace marey::assign {
namespace {

struct PieceEnd {
  double time = 0;  // s
};

TEST(Successors, SuccessorsAreThoseThatBeginLaterButNotTooLate) {
  const unsigned seed = std::random_device()();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> tenths(0, 60);  // coarse, so that times are often equal
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<PieceEnd> tails(12), heads(12);
    for (PieceEnd& end : tails) end.time = tenths(random) / 8.0;
    for (PieceEnd& end : heads) end.time = tenths(random) / 8.0;
    std::vector<std::pair<int, int>> slow, fast;
    for (int tail = 0; tail < 12; ++tail) {
      for (int head = 0; head < 12; ++head) {
        const double gap = heads[head].time - tails[tail].time;
        if (gap > 0 && gap <= 2) slow.emplace_back(tail, head);
      }
    }
    double last = 0;
    int last_tail = -1;
    for_each_successor(tails, heads, 2.0, [&](int tail, int head) {
      EXPECT_TRUE(tail > last_tail || heads[head].time >= last) << "in the order of ends, then of time";
      last = heads[head].time;
      last_tail = tail;
      fast.emplace_back(tail, head);
    });
    std::sort(fast.begin(), fast.end());
    EXPECT_EQ(fast, slow);
  }
}

TEST(Successors, EveryPieceIsInOneChain) {
  const int none = kNoIndex;
  const std::vector<int> next = {3, none, 0, none, 1, none};
  EXPECT_EQ(chains_of(next), (std::vector<std::vector<int>>{{2, 0, 3}, {4, 1}, {5}}));
  EXPECT_TRUE(chains_of({}).empty());
}

/// By brute force: a pair is clear if no other pair of either is nearly as good.
TEST(Successors, ClearOnesAreEachOthersBestByFar) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> any(0, 6);
  std::uniform_int_distribution<int> tenths(0, 30);
  constexpr int kPieces = 6;
  int found = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<PieceEnd> tails(kPieces), heads(kPieces);
    std::vector<std::vector<double>> off(kPieces, std::vector<double>(kPieces));
    for (int i = 0; i < kPieces; ++i) {
      tails[i].time = tenths(random) / 8.0;
      heads[i].time = tenths(random) / 8.0;
      for (double& one : off[i]) one = any(random);
    }
    const auto possible = [&](int tail, int head) {
      const double gap = heads[head].time - tails[tail].time;
      return gap > 0 && gap <= 2;
    };
    const ClearPair limits;
    std::vector<int> slow(kPieces, kNoIndex);
    for (int tail = 0; tail < kPieces; ++tail) {
      for (int head = 0; head < kPieces; ++head) {
        bool clear = possible(tail, head) && off[tail][head] <= limits.max_off;
        const double others = std::max(limits.clearer * off[tail][head], limits.min_clearance);
        for (int other = 0; other < kPieces; ++other) {
          if (other != head && possible(tail, other) && off[tail][other] <= others) clear = false;
          if (other != tail && possible(other, head) && off[other][head] <= others) clear = false;
        }
        if (clear) slow[tail] = head, ++found;
      }
    }
    EXPECT_EQ(clear_successors(tails, heads, 2.0, [&](int tail, int head) { return off[tail][head]; }, limits), slow);
  }
  EXPECT_GT(found, 20) << "the test is of something";
}

TEST(Successors, BestOnesMaximiseTheSumOfGains) {
  const std::vector<GatedPair> pairs{{0, 1, 3}, {0, 2, 5}, {1, 2, 4}};
  EXPECT_EQ(best_successors(3, pairs), (std::vector<int>{1, 2, kNoIndex}));
  std::vector<PieceEnd> tails{{1}, {2}}, heads{{1.5}, {9}};
  const auto gain = [](int, int head) { return head == 0 ? std::optional(2.0) : std::nullopt; };
  const auto found = successor_pairs(tails, heads, 10.0, gain);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].row, 0);
  EXPECT_EQ(found[0].column, 0);
}

}  // namespace
}  // namespace marey::assign
