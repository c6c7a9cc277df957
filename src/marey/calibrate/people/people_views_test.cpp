#include "marey/calibrate/people/people_views.h"

#include <map>
#include <utility>

#include <gtest/gtest.h>

namespace marey::calibrate::people {
namespace {

/// Ten minutes of two people with 17 points each, at 25 Hz.
std::vector<PointRow> long_walk() {
  std::vector<PointRow> rows;
  for (int k = 0; k < 15000; ++k) {
    for (int person = 0; person < 2; ++person) {
      for (std::size_t point = 0; point < 17; ++point) rows.push_back({person, k / 25.0, point});
    }
  }
  return rows;
}

TEST(SomeInstants, HaveWholePeople) {
  const std::vector<PointRow> some = some_instants(long_walk(), 6000);
  std::map<std::pair<int, double>, int> points;
  for (const PointRow& row : some) ++points[{row.person, row.time_s}];
  for (const auto& [body, count] : points) EXPECT_EQ(count, 17) << "at " << body.second << " s";
  EXPECT_LE(some.size(), 6000);
  EXPECT_GT(some.size(), 5900);
}

TEST(SomeInstants, AreSpreadOverTime) {
  const std::vector<PointRow> some = some_instants(long_walk(), 6000);
  EXPECT_LT(some.front().time_s, 3);
  EXPECT_GT(some.back().time_s, 597);
  for (std::size_t r = 1; r < some.size(); ++r) EXPECT_LT(some[r].time_s - some[r - 1].time_s, 5);
}

TEST(SomeInstants, AreAllOfAFew) {
  std::vector<PointRow> rows = long_walk();
  rows.resize(40);
  EXPECT_TRUE(some_instants({}, 10).empty());
  EXPECT_EQ(some_instants(rows, 40).size(), 40);
}

}  // namespace
}  // namespace marey::calibrate::people
