#include "marey/pipeline/people/ground/live_teams.h"

#include <random>

#include <gtest/gtest.h>

namespace marey::pipeline::people::ground {
namespace {

/// Two teams of `count` people who stand about, tracks 1, 3, … in white and 2, 4, … in blue.
struct Match {
  LiveTeams teams{analyse::TeamOptions{.names = analyse::parse_teams("City=white,United=blue"), .pitch = {}}};
  std::mt19937 random{3};
  std::map<TrackId, TrackName> named;
  double time = 0;

  void play(double seconds, int count) {
    const std::vector<analyse::TeamName> names = analyse::parse_teams("white,blue");
    std::normal_distribution<float> noise(0, 4);
    for (const double end = time + seconds; time < end; time += 0.04) {
      Instant instant;
      instant.time = timestamp_from_seconds(time);
      std::map<TrackId, Appearance> appearances;
      for (int i = 1; i <= count; ++i) {
        Sample& sample = instant.samples.emplace_back();
        sample.track = TrackId{i};
        sample.position = {5.0 * i, 30.0, 0};
        Appearance detected = names[static_cast<std::size_t>((i + 1) % 2)].colour;
        detected.lightness += noise(random);
        detected.a += noise(random);
        detected.deviation = 5;
        appearances[sample.track] = detected;
      }
      for (const TrackName& name : teams.step(instant, appearances)) {
        EXPECT_FALSE(named.contains(name.id)) << "a team that flips";
        named[name.id] = name;
      }
    }
  }
};

TEST(LiveTeams, NamesTheTeamOfEachPersonOnce) {
  Match match;
  match.play(6, 12);
  ASSERT_EQ(match.named.size(), 12U);
  for (const auto& [track, name] : match.named) {
    EXPECT_EQ(name.team, number(track) % 2 == 1 ? "City" : "United") << number(track);
    ASSERT_TRUE(name.colour);
  }
  EXPECT_GT((*match.named[TrackId{1}].colour)[0], (*match.named[TrackId{2}].colour)[0]) << "white is redder than blue";
}

TEST(LiveTeams, NamesPeopleWhoAppearLater) {
  Match match;
  match.play(4, 10);
  EXPECT_EQ(match.named.size(), 10U);
  match.play(90, 12);
  EXPECT_EQ(match.named.size(), 12U);
}

TEST(LiveTeams, NamesNoOneWithoutAppearance) {
  LiveTeams teams(analyse::TeamOptions{.names = analyse::parse_teams("white,blue"), .pitch = {}});
  for (int i = 0; i < 100; ++i) {
    Instant instant;
    instant.time = timestamp_from_seconds(i / 25.0);
    instant.samples.emplace_back().track = TrackId{1};
    EXPECT_TRUE(teams.step(instant, {}).empty());
  }
}

}  // namespace
}  // namespace marey::pipeline::people::ground
