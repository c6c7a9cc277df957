#include "marey/format/match/squads.h"

#include <functional>

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::format::match {
namespace {

constexpr const char* kSquads =
    "team,number,name,role,in,out\n"
    "Spurs,10,Kane,,,\n"
    "Spurs,1,Lloris,keeper,,\n"
    "Spurs,,\"Trialist, the\",,60,\n"
    "City,10,Grealish,,0,70.5\n"
    ",,Taylor,referee,,\n";

std::string complaint_of(const std::function<void()>& job) {
  try {
    job();
  } catch (const Error& error) {
    return error.what();
  }
  return "no complaint";
}

std::string squads_refused(const std::string& text) {
  return complaint_of([&] { parse_squads(text, "squads.csv"); });
}

TEST(Squads, AreReadWhateverTheOrderOfTheirColumns) {
  const auto squads = parse_squads(kSquads, "squads.csv");
  ASSERT_EQ(squads.size(), 5u);
  EXPECT_EQ(squads[0].label(), "10 Kane");
  EXPECT_EQ(squads[1].role, SquadRole::keeper);
  EXPECT_EQ(squads[2].label(), "Trialist, the");
  EXPECT_EQ(squads[2].in_s, 3600);
  EXPECT_EQ(squads[3].out_s, 4230);
  EXPECT_EQ(squads[4].team, "Referees");
}

TEST(Squads, RejectsImpossibleRowWithLine) {
  EXPECT_EQ(squads_refused("number,name,team\n7,Kane,A\n7,Son,A\n"),
            "squads.csv:3: number 7 is there twice in the team \"A\": 7 Kane and 7 Son");
  EXPECT_EQ(squads_refused("number,name,team\n7,Kane,A\n7,Kane,B\n"),
            "squads.csv:3: two are called 7 Kane, and could not be distinguished; write one's name otherwise");
  EXPECT_EQ(squads_refused("number,name,team\nseven,Kane,A\n"), "squads.csv:2: \"seven\" is no number of a shirt");
  EXPECT_EQ(squads_refused("number,name,team,in,out\n7,Kane,A,20,10\n"), "squads.csv:2: 7 Kane goes out before coming in");
  EXPECT_EQ(squads_refused("number,name,team,role\n7,Kane,A,coach\n"),
            "squads.csv:2: \"coach\" is not a role; player, keeper and referee are");
  EXPECT_EQ(squads_refused("number,name,team\n"), "squads.csv: names no person");
  EXPECT_EQ(squads_refused("number,name,team\n,,A\n"), "squads.csv:2: has neither a number nor a name");
}

TEST(Squads, MembersAreCalledInManyWays) {
  const auto squads = parse_squads(kSquads, "squads.csv");
  const auto called = [&](const std::string& name, const std::string& team = {}) {
    return member_called(name, team, squads, "here");
  };
  EXPECT_EQ(called("kane"), 0);
  EXPECT_EQ(called("10 Kane"), 0);
  EXPECT_EQ(called("10 City"), 3);
  EXPECT_EQ(called("City 10"), 3);
  EXPECT_EQ(called("1"), 1);
  EXPECT_EQ(called("10", "spurs"), 0);
  EXPECT_EQ(complaint_of([&] { called("10"); }),
            "here: \"10\" may be 10 Kane (Spurs) or 10 Grealish (City); say number and name, or number and team");
  EXPECT_EQ(complaint_of([&] { called("11"); }), "here: no person in the roster is called \"11\"");
}

TEST(Namings, AreReadByTime) {
  const auto squads = parse_squads(kSquads, "squads.csv");
  const auto namings = parse_namings("time,id,name,team\n1:03.2,#12,Kane,\n5,3,10,City\n", "names.csv", squads);
  ASSERT_EQ(namings.size(), 2u);
  EXPECT_EQ(namings[0].track, 3);
  EXPECT_EQ(namings[0].member, 3);
  EXPECT_EQ(namings[0].where, "names.csv:3");
  EXPECT_NEAR(namings[1].time_s, 63.2, 1e-9);
  EXPECT_EQ(namings[1].track, 12);
}

TEST(Clock, IsReadAndWritten) {
  EXPECT_EQ(seconds_of_clock("63.2"), 63.2);
  EXPECT_EQ(seconds_of_clock("0:01:03"), 63);
  EXPECT_EQ(seconds_of_clock("90:00"), 5400);
  for (const char* wrong : {"", "1:60", "-1", "1:2:3:4", "1.5:00", "noon", "1:-2"}) EXPECT_FALSE(seconds_of_clock(wrong)) << wrong;
  EXPECT_EQ(clock_of_seconds(63.24), "1:03.2");
  EXPECT_EQ(clock_of_seconds(3600), "1:00:00.0");
  EXPECT_EQ(clock_of_seconds(59.97), "1:00.0");
}

}  // namespace
}  // namespace marey::format::match
