#include "marey/track/offline/tracklet_chains.h"

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "marey/assign/no_index.h"

namespace marey::track::offline {
namespace {

struct PieceEnd {
  double time = 0;  // s
};

TEST(TrackletChains, SuccessorsAreThoseThatBeginLaterButNotTooLate) {
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

TEST(TrackletChains, EveryPieceIsInOneChain) {
  const int none = assign::kNoIndex;
  const std::vector<int> next = {3, none, 0, none, 1, none};
  EXPECT_EQ(chains_of(next), (std::vector<std::vector<int>>{{2, 0, 3}, {4, 1}, {5}}));
  EXPECT_TRUE(chains_of({}).empty());
}

}  // namespace
}  // namespace marey::track::offline
