#include "marey/geometry/layout.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace marey::geometry {
namespace {

/// Seeded, in m.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  double gaussian(double sigma) { return std::normal_distribution<double>(0, sigma)(engine_); }
  Vector<3> in_room() { return {uniform(-1.5, 1.5), uniform(-1.5, 1.5), uniform(0, 2.2)}; }

 private:
  std::mt19937_64 engine_;
};

TEST(Layout, IsFoundAmongOtherPointsWithACornerHidden) {
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    Random random(seed);
    std::vector<Vector<3>> layout, points;
    for (int i = 0; i < 12; ++i) layout.push_back({random.uniform(0, 0.5), random.uniform(0, 0.8), random.uniform(0, 0.3)});
    const Rigid3 truth{rotation_from({random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)}), random.in_room()};
    for (int i = 0; i < 5; ++i) points.push_back(random.in_room());
    const int hidden = static_cast<int>(seed) % 12;
    for (int i = 0; i < 12; ++i) {
      if (i == hidden) continue;
      points.push_back(truth * layout[static_cast<std::size_t>(i)] +
                       Vector<3>(random.gaussian(0.0005), random.gaussian(0.0005), random.gaussian(0.0005)));
    }
    const auto match = match_layout(layout, points, 0.01);
    ASSERT_TRUE(match) << "seed " << seed;
    EXPECT_EQ(match->matched, 11);
    int next = 5;
    for (int i = 0; i < 12; ++i) {
      if (i == hidden) continue;
      EXPECT_EQ(match->point_of[static_cast<std::size_t>(i)], next++) << "seed " << seed;
    }
    EXPECT_FALSE(match->point_of[static_cast<std::size_t>(hidden)]);
  }
}

TEST(Layout, OfTwoWaysToLieASymmetricOneTakesTheSmallerTurn) {
  std::vector<Vector<3>> grid;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 5; ++j) grid.push_back({0.1 * i, 0.05 * j, 0});
  }
  const Rigid3 rotated{rotation_from({0.1, 0.2, 0.4}), {1, 2, 3}};
  std::vector<Vector<3>> points;
  for (const Vector<3>& location : grid) points.push_back(rotated * location);
  const auto match = match_layout(grid, points, 0.01);
  ASSERT_TRUE(match);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(match->point_of[static_cast<std::size_t>(i)], i);
}

TEST(Layout, NoMatchWhereThereIsNone) {
  Random random(7);
  std::vector<Vector<3>> layout, points;
  for (int i = 0; i < 10; ++i) layout.push_back(random.in_room()), points.push_back(random.in_room());
  EXPECT_FALSE(match_layout(layout, points, 0.01));
  EXPECT_FALSE(match_layout(layout, std::span(points).first(2), 0.01));
  EXPECT_FALSE(match_layout(std::span(layout).first(2), points, 0.01));
}

}  // namespace
}  // namespace marey::geometry
