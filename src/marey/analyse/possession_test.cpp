#include "marey/analyse/possession.h"

#include <gtest/gtest.h>

namespace marey::analyse {
namespace {

/// Two of one team and one of another on a line, 20 m apart; the ball goes where `ball` has it.
Recording with_ball(const std::vector<Vector<3>>& ball) {
  Recording recording;
  recording.header.frame.kind = FrameOfReference::Kind::user_ground;
  recording.header.rate_hz = 10;
  const std::vector<std::pair<std::string, Vector<2>>> people{{"white", {20, 30}}, {"white", {40, 30}}, {"blue", {60, 30}}};
  for (std::size_t i = 0; i < ball.size(); ++i) {
    Instant instant;
    instant.index = static_cast<std::int64_t>(i);
    instant.time = timestamp_from_seconds(static_cast<double>(i) / 10);
    for (std::size_t p = 0; p < people.size(); ++p) {
      const TrackId id{static_cast<int>(p) + 1};
      if (i == 0) instant.named.push_back({id, std::to_string(p + 1), people[p].first});
      Sample& sample = instant.samples.emplace_back();
      sample.track = id;
      sample.position.head<2>() = people[p].second;
    }
    if (i == 0) instant.named.push_back({TrackId{9}, std::string(kBallLabel), {}, {}, TrackKind::ball});
    Sample& sample = instant.samples.emplace_back();
    sample.track = TrackId{9};
    sample.position = ball[i];
    recording.add(instant);
  }
  return recording;
}

void add_stay(std::vector<Vector<3>>& ball, double x, int instants, double y = 30.5) {
  ball.insert(ball.end(), static_cast<std::size_t>(instants), Vector<3>(x, y, 0.11));
}
void add_trajectory(std::vector<Vector<3>>& ball, double from, double to, int instants, double high) {
  for (int i = 1; i < instants; ++i) {
    const double fraction = static_cast<double>(i) / instants;
    ball.emplace_back(from + fraction * (to - from), 30.5, 0.11 + 4 * high * fraction * (1 - fraction));
  }
}

TEST(MeasureBall, TellsPassesTurnoversAndWhatIsDead) {
  std::vector<Vector<3>> ball;
  add_stay(ball, 20, 10);
  add_trajectory(ball, 20, 40, 10, 0);
  add_stay(ball, 40, 10);
  add_trajectory(ball, 40, 60, 15, 6);
  add_stay(ball, 60, 10);
  add_stay(ball, 60, 10, -3);
  add_stay(ball, 40, 10);
  const auto measured = measure_ball(with_ball(ball));
  ASSERT_TRUE(measured);
  ASSERT_EQ(measured->spells.size(), 4u);
  ASSERT_EQ(measured->passes.size(), 2u) << "after it was dead no person has passed it";
  EXPECT_EQ(measured->passes[0].from, 1);
  EXPECT_EQ(measured->passes[0].to, 2);
  EXPECT_TRUE(measured->passes[0].completed);
  EXPECT_NEAR(measured->passes[0].length_m, 20, 4);
  EXPECT_FALSE(measured->passes[1].completed);
  ASSERT_EQ(measured->teams.size(), 2u);
  EXPECT_EQ(measured->teams[1].team, "white");
  EXPECT_EQ(measured->teams[1].passes, 2);
  EXPECT_EQ(measured->teams[1].completed, 1);
  EXPECT_GT(measured->teams[1].possession_s, measured->teams[0].possession_s);
  EXPECT_NEAR(measured->dead_s, 1, 0.11);
}

TEST(MeasureBall, PassedPersonHasNoPossession) {
  std::vector<Vector<3>> ball;
  add_stay(ball, 20, 10);
  add_trajectory(ball, 20, 60, 20, 0);  // 2 m an instant past number 2
  add_stay(ball, 60, 10);
  const auto measured = measure_ball(with_ball(ball));
  ASSERT_EQ(measured->passes.size(), 1u);
  EXPECT_EQ(measured->passes[0].to, 3);
  EXPECT_FALSE(measure_ball(Recording(with_ball({}).header)));
}

}  // namespace
}  // namespace marey::analyse
