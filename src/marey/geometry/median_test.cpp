#include "marey/geometry/median.h"

#include <algorithm>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace marey::geometry {
namespace {

TEST(Median, EqualsSortedValueOfRandomSets) {
  std::mt19937 random(5);
  for (std::size_t count = 1; count < 40; ++count) {
    std::vector<int> values(count);
    for (int& value : values) value = static_cast<int>(random() % 10);
    std::vector<int> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(median(std::vector(values)), sorted[count / 2]);
    EXPECT_EQ(median_or(std::vector(values), -1), sorted[count / 2]);
    for (std::size_t n = 0; n < count; ++n) EXPECT_EQ(nth_value(std::vector(values), n), sorted[n]);
    EXPECT_EQ(quantile(std::vector(values), 0.3), sorted[static_cast<std::size_t>(0.3 * static_cast<double>(count - 1))]);
    EXPECT_EQ(median(values, std::greater<>()), sorted[count - 1 - count / 2]);
    EXPECT_EQ(median(std::span(values).first(1)), values.front());
  }
  EXPECT_EQ(median_or(std::vector<double>{}, 7), 7);
  EXPECT_EQ(quantile(std::vector<double>{}, 0.5), 0);
}

TEST(Median, WeightedEqualsMedianOfRepeatedValues) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<WeightedValue> weighted;
    std::vector<double> repeated;
    for (int i = 0; i < 9; ++i) {
      const WeightedValue one{static_cast<double>(random() % 100), static_cast<double>(random() % 4)};
      weighted.push_back(one);
      repeated.insert(repeated.end(), static_cast<std::size_t>(one.weight), one.value);
    }
    std::sort(repeated.begin(), repeated.end());
    const auto found = weighted_median(weighted);
    ASSERT_EQ(found.has_value(), !repeated.empty());
    if (!found) continue;
    EXPECT_EQ(*found, repeated[(repeated.size() - 1) / 2]) << "of an even number the lower one has half below it";
  }
  std::vector<WeightedValue> none{{1, 0}, {2, 0}};
  EXPECT_FALSE(weighted_median(none));
}

}  // namespace
}  // namespace marey::geometry
