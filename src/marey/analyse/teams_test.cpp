#include "marey/analyse/teams.h"

#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "marey/analyse/colour_names.h"
#include "marey/core/error.h"

namespace marey::analyse {
namespace {

RecordingHeader on_the_pitch() {
  RecordingHeader header;
  header.frame.kind = FrameOfReference::Kind::user_ground;
  header.rate_hz = 5;
  return header;
}

/// People and what they wear; each stands about somewhere for some seconds.
struct Scene {
  Recording recording{on_the_pitch()};
  std::vector<std::optional<Appearance>> clothing;
  std::mt19937_64 engine;
  double seconds = 20;

  explicit Scene(std::uint64_t seed) : engine(seed) {}

  double normal(double sigma) { return sigma * std::normal_distribution<double>()(engine); }

  void add(const std::string& colour, double spread, double x, double y, double from = 0, double to = 1) {
    const Appearance typical = colour_named(colour);
    clothing.push_back(Appearance{.lightness = typical.lightness + static_cast<float>(normal(spread)),
                                  .a = typical.a + static_cast<float>(normal(spread)),
                                  .b = typical.b + static_cast<float>(normal(spread)),
                                  .deviation = 3});
    for (auto k = static_cast<int>(recording.instants().size()); k < static_cast<int>(seconds * 5); ++k)
      recording.add_time_step({k, timestamp_from_seconds(k / 5.0)});
    TrackColumns track({TrackId{static_cast<int>(recording.tracks().size()) + 1}, {}, {}}, 2);
    for (int k = static_cast<int>(from * seconds * 5); k < static_cast<int>(to * seconds * 5); ++k) {
      Sample sample;
      const double dx = normal(2), dy = normal(2);
      sample.position = {x + dx, y + dy, 0};
      track.add(k, sample);
    }
    recording.put(std::move(track));
  }

  Teams find(const TeamOptions& options = {.names = {}, .pitch = geometry::PitchSize{}}) {
    return find_teams(recording, clothing, options);
  }
};

/// Ten of one colour attack towards x = 105, ten of another defend; keepers; three referees.
Scene match(std::uint64_t seed, const std::string& one = "white", const std::string& two = "blue", double spread = 4) {
  Scene scene(seed);
  for (int k = 0; k < 10; ++k) scene.add(one, spread, 30 + 5 * k, 6 * k + 5);
  for (int k = 0; k < 10; ++k) scene.add(two, spread, 45 + 5 * k, 6 * k + 8);
  scene.add("green", spread, 6, 34);
  scene.add("orange", spread, 99, 33);
  for (int k = 0; k < 3; ++k) scene.add("black", spread, 52, 34 * k);
  return scene;
}

TEST(Teams, TwoTeamsKeepersAndRefereesAreTold) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Scene scene = match(seed);
    const Teams teams = scene.find();
    ASSERT_EQ(teams.teams.size(), 2U) << "seed " << seed;
    const int white = teams.teams[0].name == "white" ? 0 : 1;
    EXPECT_EQ(teams.teams[white].name, "white") << "seed " << seed;
    EXPECT_EQ(teams.teams[1 - white].name, "blue") << "seed " << seed;
    int reported = 0;
    for (int identity = 0; identity < 20; ++identity) {
      if (!teams.members[identity].team) continue;
      ++reported;
      EXPECT_EQ(teams.members[identity].role, Teams::Role::player) << "seed " << seed << ", person " << identity;
      EXPECT_EQ(teams.members[identity].team, identity < 10 ? white : 1 - white) << "seed " << seed << ", person " << identity;
      EXPECT_GT(teams.members[identity].confidence, 0.8);
    }
    EXPECT_GE(reported, 19) << "seed " << seed;
    EXPECT_EQ(teams.members[20].role, Teams::Role::keeper);
    EXPECT_EQ(teams.members[20].team, white) << "who is behind them";
    EXPECT_EQ(teams.members[21].role, Teams::Role::keeper);
    EXPECT_EQ(teams.members[21].team, 1 - white);
    for (int identity = 22; identity < 25; ++identity) {
      EXPECT_EQ(teams.members[identity].role, Teams::Role::referee) << "seed " << seed;
      EXPECT_FALSE(teams.members[identity].team);
    }
  }
}

TEST(Teams, KeeperOfTheTeamThatIsAttackedIsItsOwn) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Scene scene(seed);
    for (int k = 0; k < 10; ++k) scene.add("white", 4, k < 7 ? 85 + k : 65, 6 * k + 5);  // attack towards x = 105
    for (int k = 0; k < 10; ++k) scene.add("blue", 4, k < 6 ? 92 + k : 55, 6 * k + 8);   // four wait in front
    scene.add("red", 4, 101, 34);
    const Teams teams = scene.find();
    ASSERT_EQ(teams.teams.size(), 2U) << "seed " << seed;
    EXPECT_EQ(teams.members[20].role, Teams::Role::keeper) << "seed " << seed;
    EXPECT_EQ(teams.members[20].team, teams.members[10].team) << "seed " << seed;
  }
}

TEST(Teams, AreCalledAsTheUserSaysInThatOrder) {
  Scene scene = match(3, "red", "yellow");
  const Teams teams = scene.find({.names = parse_teams("Away=yellow, Home=red"), .pitch = geometry::PitchSize{}});
  ASSERT_EQ(teams.teams.size(), 2U);
  EXPECT_EQ(teams.teams[0].name, "Away");
  EXPECT_EQ(teams.members[0].team, 1);
  EXPECT_EQ(teams.members[10].team, 0);
  note_teams(teams, scene.recording);
  EXPECT_EQ(scene.recording.tracks()[0].name.team, "Home");
  EXPECT_EQ(scene.recording.tracks()[20].name.label, "keeper");
  EXPECT_EQ(scene.recording.tracks()[22].name.label, "referee");
  EXPECT_EQ(scene.recording.tracks()[22].name.team, "");
}

TEST(Teams, SameKitsGiveNoWrongTeam) {
  Scene scene = match(5, "blue", "blue", 6);
  const Teams teams = scene.find();
  EXPECT_EQ(teams.teams.size(), 1U);
}

TEST(Teams, SingleTeamIsOne) {
  Scene scene(7);
  for (int k = 0; k < 8; ++k) scene.add("red", 4, 30 + 5 * k, 30);
  const Teams teams = scene.find();
  ASSERT_EQ(teams.teams.size(), 1U);
  EXPECT_EQ(teams.teams[0].name, "red");
  const Teams named = scene.find({.names = parse_teams("white,red"), .pitch = {}});
  ASSERT_EQ(named.teams.size(), 2U);
  EXPECT_EQ(named.members[0].team, 1);
  EXPECT_EQ(named.teams[0].people, 0);
}

TEST(Teams, RarelyVisiblePersonHasNoTeam) {
  Scene scene = match(9);
  scene.add("white", 4, 50, 50, 0.5, 0.52);
  scene.add("white", 4, 50, 55);
  scene.clothing.back().reset();
  scene.add("white", 4, 50, 58);
  scene.clothing.back() = Appearance{.lightness = 60, .a = 5, .b = -20, .deviation = 20};
  const Teams teams = scene.find();
  for (int identity = 25; identity < 28; ++identity) EXPECT_FALSE(teams.members[identity].team) << identity;
}

TEST(Teams, ManyShortPiecesOfPeopleAreNoTrouble) {
  Scene scene(13);
  scene.seconds = 60;
  for (int k = 0; k < 300; ++k) scene.add(k % 2 == 0 ? "sky blue" : "claret", 5, 20 + k % 60, k % 68, k / 320.0, k / 320.0 + 0.05);
  const Teams teams = scene.find();
  ASSERT_EQ(teams.teams.size(), 2U);
  int right = 0;
  const int even = teams.teams[0].name == "sky blue" ? 0 : 1;
  for (int k = 0; k < 300; ++k) right += teams.members[k].team == (k % 2 == 0 ? even : 1 - even) ? 1 : 0;
  EXPECT_GE(right, 290);
}

TEST(Teams, EmptySetHasNoTeams) {
  EXPECT_TRUE(find_teams(Recording(on_the_pitch()), {}).teams.empty());
  EXPECT_THROW(find_teams(Recording(), {}), Error) << "space is not a ground";
}

TEST(Teams, ReportsInvalidColour) {
  EXPECT_THROW(parse_teams("white,bleu"), Error);
  EXPECT_THROW(parse_teams("white"), Error);
  EXPECT_THROW(parse_teams("white,"), Error);
  EXPECT_THROW(parse_teams("white,blue,red"), Error);
  EXPECT_THROW(parse_teams("red,red"), Error);
  EXPECT_EQ(parse_teams(" Dark Green , violet")[0].name, "Dark Green");
}

TEST(ColourNames, EveryWordNamesItself) {
  for (const ColourName& name : colour_names()) EXPECT_EQ(name_of_colour(colour_named(name.word)), name.word);
}

}  // namespace
}  // namespace marey::analyse
