#include "marey/filter/human_motion.h"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace marey::filter {
namespace {

/// Places at a rate, each `sigma` m off, on a path; the same errors for the same seed.
std::vector<TimedPosition> locations(double rate, double seconds, double sigma, const std::function<Vector<2>(double)>& path,
                                     std::uint64_t seed = 3) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> off;
  std::vector<TimedPosition> all;
  for (int i = 0; i <= rate * seconds; ++i) {
    const double dx = sigma * off(engine), dy = sigma * off(engine);
    all.push_back({i / rate, path(i / rate) + Vector<2>(dx, dy), sigma * sigma * Matrix<2>::Identity()});
  }
  return all;
}

/// From rest to the top speed of a sprinter within a second and a half, back to rest in another, and the return.
Vector<2> sprinter(double t) {
  constexpr double top = 9.5, tau = 1.2;
  const auto run = [](double s) { return top * (s - tau * (1 - std::exp(-s / tau))); };
  if (t < 4) return {run(t), 0};
  const double v = top * (1 - std::exp(-4 / tau)), brake = 7, s = std::min(t - 4, v / brake);
  return {run(4) + v * s - brake * s * s / 2, 0.3 * s * s};
}

TEST(HumanMotion, AcceptsRecordSpeeds) {
  for (const double rate : {5.0, 25.0, 120.0}) {
    for (const double sigma : {0.02, 0.1, 0.3, 0.6}) {
      for (std::uint64_t seed = 1; seed <= (rate > 100 ? 1U : 5U); ++seed)
        EXPECT_TRUE(impossible_pieces(locations(rate, 6, sigma, sprinter, seed)).empty())
            << rate << " Hz, " << sigma << " m, seed " << seed;
    }
  }
}

TEST(HumanMotion, ABoxThatSlidesToTheNextPersonIsAnotherPerson) {
  // Two stroll side by side, 3 m apart; within a third of a second the places go over from one to the other.
  const auto slides = [](double t) { return Vector<2>(1.2 * t, 3 * std::clamp((t - 3) / 0.33, 0.0, 1.0)); };
  for (const double rate : {10.0, 25.0, 60.0}) {
    const auto all = locations(rate, 6, 0.1, slides);
    const auto found = impossible_pieces(all);
    ASSERT_EQ(found.size(), 1U) << rate;
    EXPECT_FALSE(found[0].one_person) << rate;
    EXPECT_NEAR(all[found[0].first].time, 3, 0.4) << rate;
    EXPECT_NEAR(all[found[0].last].time, 3.33, 0.4) << rate;
  }
}

TEST(HumanMotion, PlacesThatStrayAndComeBackAreOnePersons) {
  const auto strays = [](double t) { return Vector<2>(2 * t, t > 3 && t < 3.3 ? 2.5 : 0.0); };
  for (const double rate : {10.0, 25.0, 60.0}) {
    const auto found = impossible_pieces(locations(rate, 6, 0.1, strays));
    ASSERT_EQ(found.size(), 1U) << rate;
    EXPECT_TRUE(found[0].one_person) << rate;
  }
}

TEST(HumanMotion, LongLostPersonMayBeAnywhereReachable) {
  for (const double far : {20.0, 60.0}) {
    auto all = locations(25, 2, 0.05, [](double t) { return Vector<2>(t, 0); });
    for (TimedPosition later : locations(25, 2, 0.05, [&](double t) { return Vector<2>(far + t, 0); })) {
      later.time += 5;
      all.push_back(later);
    }
    const auto found = impossible_pieces(all);
    EXPECT_EQ(found.size(), far > 50 ? 1U : 0U) << "3 s without being seen, and " << far << " m";
    if (!found.empty()) {
      EXPECT_FALSE(found[0].one_person);
    }
  }
}

TEST(HumanMotion, NothingIsKnownOfFewPlaces) {
  EXPECT_TRUE(impossible_pieces({}).empty());
  const std::vector<TimedPosition> two = {{0, {0, 0}, 0.01 * Matrix<2>::Identity()}, {0.5, {4, 0}, 0.01 * Matrix<2>::Identity()}};
  EXPECT_TRUE(impossible_pieces(two).empty());
}

}  // namespace
}  // namespace marey::filter
