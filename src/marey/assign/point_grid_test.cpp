#include "marey/assign/point_grid.h"

#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace marey::assign {
namespace {

template <int D>
void agrees_with_looking_at_all(unsigned seed, double extent) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> location(-extent, extent);
  const auto anywhere = [&] {
    Vector<D> x;
    for (int i = 0; i < D; ++i) x[i] = location(random);
    return x;
  };
  std::vector<Vector<D>> points(random() % 200);
  for (auto& point : points) point = anywhere();
  PointGrid<D> grid;
  grid.build(points, 1 + random() % 50);
  for (int query = 0; query < 20; ++query) {
    const Vector<D> centre = 1.5 * anywhere();
    const double radius = static_cast<double>(random() % 300);
    std::multiset<int> found;
    grid.for_each_near(centre, radius, [&](int index) { found.insert(index); });
    for (int i = 0; i < static_cast<int>(points.size()); ++i) {
      EXPECT_LE(found.count(i), 1U);
      if ((points[i] - centre).norm() <= radius) {
        EXPECT_EQ(found.count(i), 1U) << "seed " << seed;
      }
    }
  }
}

TEST(PointGrid, MissesNoPointNearby) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    agrees_with_looking_at_all<2>(seed, 300);
    agrees_with_looking_at_all<3>(seed, 300);
    agrees_with_looking_at_all<2>(seed, 1e12);
    agrees_with_looking_at_all<3>(seed, 1e12);
  }
}

TEST(PointGrid, LooksAtFewOfMany) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> location(0, 10000);
  std::vector<Vector<2>> points(10000);
  for (auto& point : points) point = {location(random), location(random)};
  PointGrid<2> grid;
  grid.build(points, 100);
  int visited = 0;
  for (const auto& point : points) grid.for_each_near(point, 100, [&](int) { ++visited; });
  EXPECT_LT(visited / 10000, 20);
}

}  // namespace
}  // namespace marey::assign
