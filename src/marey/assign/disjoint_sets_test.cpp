#include "marey/assign/disjoint_sets.h"

#include <random>

#include <gtest/gtest.h>

namespace marey::assign {
namespace {

TEST(DisjointSets, AsPaintingNeighboursUntilNothingChanges) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  DisjointSets sets;
  for (int round = 0; round < 200; ++round) {
    const int count = static_cast<int>(random() % 30) + 1;
    sets.reset(count);
    std::vector<std::pair<int, int>> edges(random() % 30);
    for (auto& [a, b] : edges) {
      a = static_cast<int>(random() % count);
      b = static_cast<int>(random() % count);
      sets.join(a, b);
    }
    std::vector<int> colour(count);
    for (int i = 0; i < count; ++i) colour[i] = i;
    for (bool changed = true; changed;) {
      changed = false;
      for (const auto& [a, b] : edges) {
        const int lowest = std::min(colour[a], colour[b]);
        changed = changed || colour[a] != lowest || colour[b] != lowest;
        colour[a] = colour[b] = lowest;
      }
    }
    for (int i = 0; i < count; ++i) EXPECT_EQ(sets.find(i), colour[i]);
  }
}

}  // namespace
}  // namespace marey::assign
