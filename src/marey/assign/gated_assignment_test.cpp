#include "marey/assign/gated_assignment.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace marey::assign {
namespace {

double gain_of(std::span<const int> columns, std::span<const GatedPair> pairs) {
  double sum = 0;
  for (const GatedPair& pair : pairs) {
    if (columns[pair.row] == pair.column) sum += pair.gain;
  }
  return sum;
}

/// The slow twin: tries, row by row, none and every column of the pairs that is still free.
double best_gain(int row, int rows, std::vector<char>& taken, std::span<const GatedPair> pairs) {
  if (row == rows) return 0;
  double best = best_gain(row + 1, rows, taken, pairs);
  for (const GatedPair& pair : pairs) {
    if (pair.row != row || taken[pair.column] || pair.gain <= 0) continue;
    taken[pair.column] = 1;
    best = std::max(best, pair.gain + best_gain(row + 1, rows, taken, pairs));
    taken[pair.column] = 0;
  }
  return best;
}

std::vector<GatedPair> random_pairs(std::mt19937& random, int rows, int columns, double density) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<GatedPair> pairs;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (unit(random) < density) pairs.push_back({row, column, std::round(20 * unit(random)) / 2 - 2});
    }
  }
  return pairs;
}

TEST(GatedAssigner, IsAsGoodAsTryingEverything) {
  GatedAssigner assigner;
  for (unsigned seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    const int rows = 1 + static_cast<int>(random() % 6);
    const int columns = 1 + static_cast<int>(random() % 6);
    const auto pairs = random_pairs(random, rows, columns, 0.2 + 0.2 * (seed % 5));
    const auto result = assigner.assign(rows, columns, pairs);
    std::vector<int> used;
    for (int row = 0; row < rows; ++row) {
      if (result[row] == kNoIndex) continue;
      used.push_back(result[row]);
      EXPECT_TRUE(std::any_of(pairs.begin(), pairs.end(), [&](const GatedPair& pair) {
        return pair.row == row && pair.column == result[row] && pair.gain > 0;
      }));
    }
    std::sort(used.begin(), used.end());
    EXPECT_EQ(std::adjacent_find(used.begin(), used.end()), used.end()) << "a column was given twice";
    std::vector<char> taken(columns, 0);
    EXPECT_NEAR(gain_of(result, pairs), best_gain(0, rows, taken, pairs), 1e-9);
  }
}

TEST(GatedAssigner, DoesNotDependOnTheOrderOfPairs) {
  GatedAssigner assigner;
  std::mt19937 random(5);
  for (int trial = 0; trial < 50; ++trial) {
    auto pairs = random_pairs(random, 30, 30, 0.08);
    const auto first = assigner.assign(30, 30, pairs);
    const std::vector<int> before(first.begin(), first.end());
    std::shuffle(pairs.begin(), pairs.end(), random);
    const auto again = assigner.assign(30, 30, pairs);
    EXPECT_TRUE(std::equal(before.begin(), before.end(), again.begin()));
  }
}

TEST(GatedAssigner, AnEndlessComponentTakesBoundedTime) {
  const int n = 3 * GatedAssigner::largest_component;
  std::vector<GatedPair> chain;  // each row may have its own column or the next one's, which is worth less
  for (int row = 0; row < n; ++row) {
    chain.push_back({row, row, 2});
    if (row + 1 < n) chain.push_back({row, row + 1, 1});
  }
  GatedAssigner assigner;
  const auto result = assigner.assign(n, n, chain);
  for (int row = 0; row < n; ++row) ASSERT_EQ(result[row], row);
}

TEST(GatedAssigner, NothingToAssign) {
  GatedAssigner assigner;
  EXPECT_TRUE(assigner.assign(0, 0, {}).empty());
  const auto result = assigner.assign(2, 0, {});
  EXPECT_EQ(std::vector<int>(result.begin(), result.end()), std::vector<int>(2, kNoIndex));
}

}  // namespace
}  // namespace marey::assign
