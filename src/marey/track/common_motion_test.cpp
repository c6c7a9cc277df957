#include "marey/track/common_motion.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace marey::track {
namespace {

std::vector<Sighting> crowd(std::mt19937& random, int people) {
  std::uniform_real_distribution<double> x(0, 800);
  std::uniform_real_distribution<double> size(60, 200);
  std::vector<Sighting> all;
  for (int i = 0; i < people; ++i) all.push_back({{x(random), x(random) / 2}, size(random)});
  return all;
}

TEST(CommonMotion, FindsTheShiftThatEverybodyShares) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 2);
    const auto expected = crowd(random, 10);
    const Vector<2> shift(25 + seed % 10, -12);
    std::vector<Sighting> seen;
    for (std::size_t i = 2; i < expected.size(); ++i) {  // two are missed
      seen.push_back({expected[i].place + shift + Vector<2>(noise(random), noise(random)), expected[i].size * 1.03});
    }
    const auto strangers = crowd(random, 3);
    seen.insert(seen.end(), strangers.begin(), strangers.end());
    EXPECT_LT((common_motion(expected, seen) - shift).norm(), 6) << "seed " << seed;
  }
}

TEST(CommonMotion, IsNoneWhereTheCameraStandsStill) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 2);
    const auto expected = crowd(random, 10);
    auto seen = expected;
    for (Sighting& one : seen) one.place += Vector<2>(noise(random), noise(random));
    EXPECT_EQ(common_motion(expected, seen), Vector<2>(0, 0)) << "seed " << seed;
  }
}

TEST(CommonMotion, TooFewPeopleTellNothing) {
  const std::vector<Sighting> expected{{{100, 100}, 80}, {{300, 100}, 80}};
  const std::vector<Sighting> seen{{{130, 100}, 80}, {{330, 100}, 80}};
  EXPECT_EQ(common_motion(expected, seen), Vector<2>(0, 0));
  EXPECT_EQ(common_motion({}, {}), Vector<2>(0, 0));
}

}  // namespace
}  // namespace marey::track
