#include "marey/track/ground/ground_teams.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace marey::track::ground {
namespace {

class Shirts {
 public:
  explicit Shirts(unsigned seed) : random_(seed) {}

  Appearance in(double lightness, double a, double b, double spread) {
    std::normal_distribution<double> noise(0, spread);
    return {.lightness = static_cast<float>(lightness + noise(random_)),
            .a = static_cast<float>(a + noise(random_)),
            .b = static_cast<float>(b + noise(random_)),
            .deviation = 3};
  }

 private:
  std::mt19937 random_;
};

/// White and blue as a camera with a cast of blue shows them, and two referees.
std::vector<Appearance> match(Shirts& shirts) {
  std::vector<Appearance> seen;
  for (int i = 0; i < 1000; ++i) {
    seen.push_back(shirts.in(63, 13, -28, 4));
    seen.push_back(shirts.in(39, 21, -47, 4));
    if (i % 6 == 0) seen.push_back(shirts.in(25, 2, -4, 4));
  }
  return seen;
}

TEST(GroundTeams, ShirtsOfOneHueAreToldApart) {
  double mean = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    Shirts shirts(seed);
    const auto teams = GroundTeams::learn(match(shirts));
    ASSERT_TRUE(teams) << "seed " << seed;
    EXPECT_GT(teams->apart(), 5);
    const Appearance white = shirts.in(63, 13, -28, 3), blue = shirts.in(39, 21, -47, 3), other = shirts.in(63, 13, -28, 3);
    EXPECT_GT(teams->same(white, other), 0.4) << "seed " << seed;
    EXPECT_LE(teams->same(white, other), std::log(2) + 1e-9);
    EXPECT_LT(teams->same(white, blue), 0) << "seed " << seed;
    mean += teams->same(white, blue) / 100;
    EXPECT_DOUBLE_EQ(teams->same(white, blue), teams->same(blue, white));
    const Appearance referee = shirts.in(25, 2, -4, 2);
    EXPECT_GT(teams->same(white, referee), -1) << "neither's colour says nothing, seed " << seed;
  }
  EXPECT_LT(mean, -1.5);
}

TEST(GroundTeams, PeopleInClothesOfTheirOwnAreNotTakenForOthers) {
  int pairs = 0, doubted = 0;  // twenty people may happen to be of two kinds: that says nothing false of anybody
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> lightness(15, 90), colour(-40, 40);
    Shirts shirts(seed);
    std::vector<Appearance> seen;
    for (int person = 0; person < 20; ++person) {
      const double l = lightness(random), a = colour(random), b = colour(random);
      for (int i = 0; i < 100; ++i) seen.push_back(shirts.in(l, a, b, 4));
    }
    const auto teams = GroundTeams::learn(seen);
    for (std::size_t i = 1; teams && i < seen.size(); i += 2) {
      ++pairs;
      doubted += teams->same(seen[i - 1], seen[i]) < -1 ? 1 : 0;
    }
  }
  EXPECT_GT(pairs, 1000);
  EXPECT_LT(doubted, 0.01 * pairs) << "seeds 0 to 99";
}

TEST(GroundTeams, OneShirtAndFewColoursAreNoTeams) {
  Shirts shirts(1);
  std::vector<Appearance> seen;
  EXPECT_FALSE(GroundTeams::learn(seen));
  for (int i = 0; i < 2000; ++i) seen.push_back(shirts.in(60, 10, -20, 4));
  EXPECT_FALSE(GroundTeams::learn(seen)) << "all alike";
  const std::vector<Appearance> same(1000, Appearance{.lightness = 50, .a = 0, .b = 0, .deviation = 2});
  EXPECT_FALSE(GroundTeams::learn(same)) << "not even noise";
  Shirts other(2);
  const std::vector<Appearance> all = match(other);
  EXPECT_FALSE(GroundTeams::learn(std::span(all).first(100)));
}

}  // namespace
}  // namespace marey::track::ground
