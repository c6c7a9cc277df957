#include "marey/simulate/match/match_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace marey::simulate::match {
namespace {

TEST(MatchMotion, IsTheSameAtEveryRate) {
  MatchMotion fast(3), slow(3), other(4);
  double apart = 0;
  for (int k = 0; k <= 400; ++k) {
    fast.advance(k * 0.01);
    if (k % 50 != 0) continue;
    slow.advance(k * 0.01);
    other.advance(k * 0.01);
    for (std::size_t i = 0; i < kMatchPeople; ++i) {
      EXPECT_EQ(fast.people()[i].location, slow.people()[i].location);
      EXPECT_EQ(fast.people()[i].velocity, slow.people()[i].velocity);
      EXPECT_EQ(fast.people()[i].heading, slow.people()[i].heading);
      apart = std::max(apart, (fast.people()[i].location - other.people()[i].location).norm());
    }
  }
  EXPECT_GT(apart, 1) << "seeds make no difference";
}

TEST(MatchMotion, VelocityIsTheDerivativeOfPlace) {
  constexpr double kShort = 1e-4;
  MatchMotion before(5), now(5), after(5);
  for (int k = 1; k <= 500; ++k) {
    const double t = 0.0371 * k;
    before.advance(t - kShort);
    now.advance(t);
    after.advance(t + kShort);
    for (std::size_t i = 0; i < kMatchPeople; ++i) {
      const Vector<2> slope = (after.people()[i].location - before.people()[i].location) / (2 * kShort);
      EXPECT_LT((slope - now.people()[i].velocity).norm(), 0.01);
    }
  }
}

struct Motion {
  std::array<double, kMatchPeople> metres{}, fastest{}, longest_stand{};
  double nearest = 1e9, sideways = 0, hard = 0, close_pairs = 0;  // the last three: shares of all people and instants; per instant
};

Motion motion_over(std::uint64_t seed, double seconds) {
  constexpr double kStep = 0.05;
  MatchMotion match(seed);
  Motion all;
  std::array<double, kMatchPeople> stood{};
  std::array<Vector<2>, kMatchPeople> last;
  const int count = static_cast<int>(seconds / kStep);
  for (int k = 0; k < count; ++k) {
    match.advance(k * kStep);
    for (std::size_t i = 0; i < kMatchPeople; ++i) {
      const MatchPerson& person = match.people()[i];
      const double speed = person.velocity.norm();
      all.metres[i] += speed * kStep;
      all.fastest[i] = std::max(all.fastest[i], speed);
      stood[i] = speed < 0.2 ? stood[i] + kStep : 0;
      all.longest_stand[i] = std::max(all.longest_stand[i], stood[i]);
      if (k > 0 && (person.velocity - last[i]).norm() / kStep > 6) all.hard += 1.0 / (count * kMatchPeople);
      last[i] = person.velocity;
      EXPECT_TRUE(person.location.x() > -3 && person.location.x() < 108 && person.location.y() > -3 && person.location.y() < 71);
      for (std::size_t j = 0; j < i; ++j) {
        const double away = (person.location - match.people()[j].location).norm();
        all.nearest = std::min(all.nearest, away);
        if (away < 1.2) all.close_pairs += 1.0 / count;
      }
    }
  }
  return all;
}

TEST(MatchMotion, PeopleMoveAsInAMatch) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    constexpr double kMinutes = 10;
    const Motion all = motion_over(seed, 60 * kMinutes);
    double outfield = 0;
    for (std::size_t i = 0; i < kMatchPlayers; ++i) {
      const bool keeper = i % kMatchSide == 0;
      const double a_minute = all.metres[i] / kMinutes;
      EXPECT_GT(a_minute, keeper ? 15 : 70) << i;
      EXPECT_LT(a_minute, keeper ? 70 : 170) << i;
      if (!keeper) outfield += a_minute / 20;
      EXPECT_LT(all.fastest[i], 9.5);
      EXPECT_GT(all.longest_stand[i], 4) << "no person stands as little as " << i;
    }
    EXPECT_GT(outfield, 95);
    EXPECT_LT(outfield, 135);
    EXPECT_GT(*std::max_element(all.fastest.begin(), all.fastest.end()), 7.5) << "no person sprints";
    EXPECT_GT(all.nearest, 0.4);
    EXPECT_GT(all.close_pairs, 0.1) << "people never meet";
    EXPECT_LT(all.hard, 1e-3) << "bodies are thrown about";
  }
}

TEST(MatchMotion, PeopleHaveNamesAndSides) {
  EXPECT_EQ(match_label(0), "1");
  EXPECT_EQ(match_label(10), "11");
  EXPECT_EQ(match_label(11), "1");
  EXPECT_EQ(match_label(24), "A2");
  EXPECT_EQ(match_team(10), "white");
  EXPECT_EQ(match_team(11), "blue");
  EXPECT_EQ(match_team(22), "referee");
}

}  // namespace
}  // namespace marey::simulate::match
