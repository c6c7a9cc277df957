#include "marey/assign/linear_assignment.h"

#include <algorithm>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace marey::assign {
namespace {

/// Every assignment that gives each of the shorter side one of the longer.
double cheapest_by_trying_all(int rows, int columns, const std::vector<double>& costs) {
  const bool flat = rows <= columns;
  std::vector<int> order(std::max(rows, columns));
  std::iota(order.begin(), order.end(), 0);
  double cheapest = std::numeric_limits<double>::infinity();
  do {
    double total = 0;
    for (int i = 0; i < std::min(rows, columns); ++i) total += flat ? costs[i * columns + order[i]] : costs[order[i] * columns + i];
    cheapest = std::min(cheapest, total);
  } while (std::next_permutation(order.begin(), order.end()));
  return cheapest;
}

TEST(LinearAssignment, AsCheapAsTryingAll) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  LinearAssigner assigner;
  for (int round = 0; round < 300; ++round) {
    const int rows = static_cast<int>(random() % 6) + 1;
    const int columns = static_cast<int>(random() % 6) + 1;
    std::vector<double> costs(rows * columns);
    for (double& cost : costs)
      cost = round % 2 == 0 ? static_cast<double>(random() % 4) : static_cast<double>(random()) / 1e6 - 2000;
    const auto columns_of = assigner.assign(rows, columns, costs);
    double total = 0;
    std::vector<int> taken;
    for (int row = 0; row < rows; ++row) {
      if (columns_of[row] == kNoIndex) continue;
      total += costs[row * columns + columns_of[row]];
      taken.push_back(columns_of[row]);
    }
    EXPECT_EQ(static_cast<int>(taken.size()), std::min(rows, columns));
    std::sort(taken.begin(), taken.end());
    EXPECT_EQ(std::adjacent_find(taken.begin(), taken.end()), taken.end());
    EXPECT_NEAR(total, cheapest_by_trying_all(rows, columns, costs), 1e-9);
  }
}

TEST(LinearAssignment, DrawsAreSettledByIndex) {
  LinearAssigner assigner;
  const std::vector<double> equal(12, 1.0);
  const auto flat = assigner.assign(3, 4, equal);
  EXPECT_EQ(std::vector<int>(flat.begin(), flat.end()), (std::vector<int>{0, 1, 2}));
  const auto tall = assigner.assign(4, 3, equal);
  EXPECT_EQ(std::vector<int>(tall.begin(), tall.end()), (std::vector<int>{0, 1, 2, kNoIndex}));
}

TEST(LinearAssignment, NothingToAssign) {
  LinearAssigner assigner;
  EXPECT_TRUE(assigner.assign(0, 3, {}).empty());
  const auto lonely = assigner.assign(2, 0, {});
  EXPECT_EQ(std::vector<int>(lonely.begin(), lonely.end()), std::vector<int>(2, kNoIndex));
}

}  // namespace
}  // namespace marey::assign
