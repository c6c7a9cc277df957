#include "marey/assign/association_marginals.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace marey::assign {
namespace {

/// The slow twin: every answer is listed.
std::vector<double> listed(int rows, int columns, const std::vector<GatedPair>& pairs) {
  std::vector<double> sums(pairs.size(), 0);
  std::vector<char> used(static_cast<std::size_t>(columns), 0);
  std::vector<std::size_t> chosen;
  double total = 0;
  const std::function<void(int, double)> visit = [&](int row, double weight) {
    if (row == rows) {
      total += weight;
      for (const std::size_t i : chosen) sums[i] += weight;
      return;
    }
    visit(row + 1, weight);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (pairs[i].row != row || used[pairs[i].column]) continue;
      used[pairs[i].column] = 1;
      chosen.push_back(i);
      visit(row + 1, weight * std::exp(pairs[i].gain));
      chosen.pop_back();
      used[pairs[i].column] = 0;
    }
  };
  visit(0, 1);
  for (double& sum : sums) sum /= total;
  return sums;
}

std::vector<GatedPair> random_pairs(std::mt19937_64& engine, int rows, int columns, double fraction) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<GatedPair> pairs;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (uniform(engine) < fraction) pairs.push_back({row, column, 8 * uniform(engine) - 3});
    }
  }
  std::shuffle(pairs.begin(), pairs.end(), engine);
  return pairs;
}

TEST(AssociationMarginals, AgreeWithListingEveryAnswer) {
  AssociationMarginals marginals;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    std::mt19937_64 engine(seed);
    const int rows = 1 + static_cast<int>(seed % 6), columns = 1 + static_cast<int>(seed / 6 % 6);
    const auto pairs = random_pairs(engine, rows, columns, 0.2 + 0.1 * static_cast<double>(seed % 8));
    const auto slow = listed(rows, columns, pairs);
    const auto fast = marginals.find(rows, columns, pairs);
    ASSERT_EQ(fast.size(), slow.size());
    for (std::size_t i = 0; i < slow.size(); ++i) EXPECT_NEAR(fast[i], slow[i], 1e-12) << "seed " << seed;
  }
}

TEST(AssociationMarginals, StayFiniteForGreatGains) {
  std::vector<GatedPair> pairs;
  for (int row = 0; row < 10; ++row) {
    for (int column = 0; column < 10; ++column) pairs.push_back({row, column, row == column ? 300.0 : 200.0});
  }
  AssociationMarginals marginals;
  const auto found = marginals.find(10, 10, pairs);
  for (std::size_t i = 0; i < pairs.size(); ++i) EXPECT_NEAR(found[i], pairs[i].row == pairs[i].column ? 1 : 0, 1e-9);
}

TEST(AssociationMarginals, LargeClustersAreSummedOverTheirBestAnswers) {
  // A chain of rows that each prefer their own column: little weight lies beyond the best answers.
  constexpr int count = 2 * AssociationMarginals::max_columns;
  std::vector<GatedPair> pairs;
  for (int row = 0; row < count; ++row) {
    pairs.push_back({row, row, 9});
    pairs.push_back({row, (row + 1) % count, 1});
  }
  AssociationMarginals marginals;
  const auto found = marginals.find(count, count, pairs);
  for (std::size_t i = 0; i < pairs.size(); ++i) EXPECT_NEAR(found[i], i % 2 == 0 ? 1 : 0, 0.01) << i;
}

TEST(AssociationMarginals, NothingComesOfNothing) {
  AssociationMarginals marginals;
  EXPECT_TRUE(marginals.find(3, 0, {}).empty());
}

}  // namespace
}  // namespace marey::assign
