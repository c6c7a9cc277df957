#include "marey/assign/sparse_assignment.h"

#include <random>
#include <set>

#include <gtest/gtest.h>

namespace marey::assign {
namespace {

/// Numbers that are the same everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  int integer(int low, int high) { return static_cast<int>(uniform(low, high + 1)); }
  bool chance(double probability) { return uniform(0, 1) < probability; }

 private:
  std::mt19937_64 engine_;
};

double merit(std::span<const int> columns, const std::vector<GatedPair>& pairs) {
  double sum = 0;
  std::set<int> used;
  for (int row = 0; row < static_cast<int>(columns.size()); ++row) {
    if (columns[row] == kNoIndex) continue;
    EXPECT_TRUE(used.insert(columns[row]).second) << "column " << columns[row] << " is given twice";
    bool found = false;
    for (const GatedPair& pair : pairs) {
      if (pair.row != row || pair.column != columns[row]) continue;
      sum += pair.gain;
      found = true;
    }
    EXPECT_TRUE(found) << "row " << row << " has a column that it may not have";
  }
  return sum;
}

/// Every assignment of columns to rows.
double best_of_all(int row, int rows, std::set<int>& used, const std::vector<GatedPair>& pairs) {
  if (row == rows) return 0;
  double best = best_of_all(row + 1, rows, used, pairs);
  for (const GatedPair& pair : pairs) {
    if (pair.row != row || !used.insert(pair.column).second) continue;
    best = std::max(best, pair.gain + best_of_all(row + 1, rows, used, pairs));
    used.erase(pair.column);
  }
  return best;
}

std::vector<GatedPair> random_pairs(Random& random, int rows, int columns, double fraction) {
  std::vector<GatedPair> pairs;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (random.chance(fraction)) pairs.push_back({row, column, random.uniform(-2, 10)});
    }
  }
  return pairs;
}

TEST(SparseAssignment, IsTheBestOfAllOnSmallProblems) {
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    Random random(seed);
    const int rows = random.integer(0, 6);
    const int columns = random.integer(1, 6);
    const std::vector<GatedPair> pairs = random_pairs(random, rows, columns, random.uniform(0.2, 1));
    std::set<int> used;
    EXPECT_NEAR(merit(sparse_assignment(rows, columns, pairs), pairs), best_of_all(0, rows, used, pairs), 1e-9) << "seed " << seed;
  }
}

TEST(SparseAssignment, AgreesWithTheDenseSolverOnLargerOnes) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    const std::vector<GatedPair> pairs = random_pairs(random, 120, 100, random.uniform(0.02, 0.5));
    GatedAssigner dense;
    EXPECT_NEAR(merit(sparse_assignment(120, 100, pairs), pairs), merit(dense.assign(120, 100, pairs), pairs), 1e-7)
        << "seed " << seed;
  }
}

}  // namespace
}  // namespace marey::assign
