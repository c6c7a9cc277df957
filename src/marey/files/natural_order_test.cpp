#include "marey/files/natural_order.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace marey {
namespace {

TEST(NaturalOrder, NumbersCompareByValue) {
  const std::vector<std::string> sorted{"",      "1, blue", "2, blue", "10, blue", "R, referee",
                                        "match", "match2",  "match10", "match10b"};
  std::vector<std::string> names = sorted;
  std::shuffle(names.begin(), names.end(), std::mt19937(3));  // NOLINT: a seed, so that a failure comes back
  std::sort(names.begin(), names.end(), NaturalOrder());
  EXPECT_EQ(names, sorted);
}

TEST(NaturalOrder, IsOneOfAll) {
  const std::vector<std::string> names{"a",   "a0", "a00", "a01", "a1",  "a1b",   "a01b", "a01c",
                                       "a10", "0",  "00",  "",    "1a2", "01a02", "1a02"};
  const NaturalOrder less;
  for (const auto& a : names) {
    for (const auto& b : names) {
      EXPECT_EQ(less(a, b) + less(b, a), a == b ? 0 : 1) << a << " " << b;
      for (const auto& c : names) EXPECT_TRUE(!less(a, b) || !less(b, c) || less(a, c)) << a << " " << b << " " << c;
    }
  }
}

}  // namespace
}  // namespace marey
