#include "marey/simulate/match/match_ball.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "marey/simulate/match/match_motion.h"

namespace marey::simulate::match {
namespace {

TEST(MatchBall, RollsFliesIsHeldAndGoesOutAsBallsDo) {
  MatchMotion motion(7);
  std::array<int, 4> states{};
  double highest = 0, fastest = 0;
  int held = 0, away = 0;  // of a held ball's instants, those in which it still moves to the holder
  for (int i = 1; i < 25 * 180; ++i) {
    const BallPosition before = motion.ball_position();
    motion.advance(i / 25.0);
    const BallPosition ball = motion.ball_position();
    ++states[static_cast<std::size_t>(ball.state)];
    ASSERT_GE(ball.location.z(), kBallRadius - 1e-9);
    highest = std::max(highest, ball.location.z());
    fastest = std::max(fastest, ball.velocity.norm());
    if (!before.there || !ball.there || ball.state == BallState::dead) continue;
    ASSERT_LT((ball.location - before.location).norm(), 45 / 25.0)
        << "it jumps at " << i / 25.0 << " s, " << to_string(before.state) << " to " << to_string(ball.state);
    if (ball.state == BallState::held && before.state == BallState::held && before.holder == ball.holder) {
      const Vector<2> holder = motion.people()[static_cast<std::size_t>(ball.holder)].location;
      const double apart = (ball.location.head<2>() - holder).norm();
      EXPECT_LT(apart, 20) << i / 25.0;  // a pass that went astray; how far depends on how the compiler rounds
      ++held;
      away += apart > 2 ? 1 : 0;
    }
  }
  for (const int count : states) EXPECT_GT(count, 25);
  EXPECT_LT(away, 0.25 * held);
  EXPECT_GT(highest, 2.5);
  EXPECT_LT(highest, 20);
  EXPECT_LT(fastest, 45);
}

TEST(MatchBall, FliesUnderGravityAndSlowsInTheAir) {
  MatchMotion motion(3);
  int checked = 0;
  for (int i = 1; i < 50 * 120; ++i) {
    motion.advance(i / 50.0);
    const BallPosition a = motion.ball_position();
    motion.advance((i + 0.9) / 50.0);
    if (a.state != BallState::flying || a.location.z() < 1 || std::abs(a.velocity.z()) > 8) continue;
    MatchMotion later = motion;
    later.advance((i + 2) / 50.0);
    const BallPosition b = later.ball_position();
    if (b.state != BallState::flying || b.location.z() < 1) continue;
    EXPECT_NEAR(b.velocity.z() - a.velocity.z(), -9.81 * 0.04, 0.3);  // to a step of 0.02 s
    EXPECT_LT(b.velocity.norm() - a.velocity.norm(), 0.5);
    ++checked;
  }
  EXPECT_GT(checked, 50);
}

}  // namespace
}  // namespace marey::simulate::match
