#include "marey/pipeline/identify/numbers.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::pipeline::identify {
namespace {

const std::vector<SquadMember>& squads() {
  static const std::vector<SquadMember> squads =
      format::match::parse_squads("number,name,team\n1,Adams,Reds\n7,Brown,Reds\n7,Davis,Blues\n9,Evans,Blues\n", "squads.csv");
  return squads;
}

/// Tracks 1 to `teams.size()`, all there for 10 s, 5 a second; the last one leaves after 4 s.
Recording recording(const std::vector<std::string>& teams) {
  Recording made;
  made.header.frame.kind = FrameOfReference::Kind::ground;
  for (int i = 0; i < 50; ++i) {
    Instant instant;
    instant.index = i;
    instant.time = timestamp_from_seconds(i / 5.0);
    for (std::size_t k = 0; k < teams.size(); ++k) {
      const TrackId id{static_cast<int>(k) + 1};
      if (i == 0) instant.named.push_back({.id = id, .label = "", .team = teams[k]});
      if (k + 1 == teams.size() && i >= 20) continue;
      Sample sample;
      sample.track = id;
      sample.position = {static_cast<double>(k), 0, 0};
      instant.samples.push_back(sample);
    }
    made.add(instant);
  }
  return made;
}

NumberNamings named(const std::string& rows, const std::vector<std::string>& teams, const std::vector<SquadNaming>& given = {}) {
  return namings_by_numbers(parse_numbers("id,number,probability,readings,time\n" + rows, "numbers.csv"), 0.95, squads(), given,
                            recording(teams));
}

TEST(ReadNumbers, NameTheMemberOfTheTracksTeam) {
  const NumberNamings found = named("1,7,0.99,4,2.0\n2,7,0.98,3,1.0\n3,1,0.7,3,1.0\n", {"Reds", "Blues", "Reds"});
  ASSERT_EQ(found.namings.size(), 2U);
  EXPECT_EQ(found.namings[0].track, 2);
  EXPECT_EQ(squads()[static_cast<std::size_t>(found.namings[0].member)].name, "Davis");
  EXPECT_EQ(squads()[static_cast<std::size_t>(found.namings[1].member)].name, "Brown");
  EXPECT_TRUE(found.messages.empty());
}

TEST(ReadNumbers, NameNoPersonOfSeveral) {
  const NumberNamings found = named("1,7,0.99,4,2.0\n", {"", ""});
  EXPECT_TRUE(found.namings.empty());
  ASSERT_EQ(found.messages.size(), 1U);
  EXPECT_NE(found.messages[0].find("7 Brown and 7 Davis"), std::string::npos) << found.messages[0];
}

TEST(ReadNumbers, ThatTheSquadsLackNameNoPerson) {
  const NumberNamings found = named("1,23,0.99,4,2.0\n2,1,0.99,4,2.0\n", {"Reds", "Blues"});
  EXPECT_TRUE(found.namings.empty());
  ASSERT_EQ(found.messages.size(), 2U);
  EXPECT_NE(found.messages[0].find("number 23"), std::string::npos);
  EXPECT_NE(found.messages[1].find("of Blues"), std::string::npos);
}

TEST(ReadNumbers, OfTwoPeopleAtOneTimeNameNeither) {
  const NumberNamings found = named("1,7,0.99,4,2.0\n2,7,0.99,4,2.0\n", {"Reds", "Reds"});
  EXPECT_TRUE(found.namings.empty());
  EXPECT_EQ(found.messages.size(), 2U);
}

TEST(ReadNumbers, GiveWayToAHand) {
  const std::vector<SquadNaming> given{{.time_s = 1, .track = 1, .member = 0, .where = "names.csv:2"}};
  EXPECT_TRUE(named("1,7,0.99,4,2.0\n2,1,0.99,3,1.0\n", {"Reds", "Reds"}, given).namings.empty());
}

TEST(ReadNumbers, RejectMalformedInput) {
  const std::string head = "id,number,probability,readings,time\n";
  for (const char* row : {"0,7,0.9,1,1", "x,7,0.9,1,1", "1,777,0.9,1,1", "1,-7,0.9,1,1", "1,7,1.5,1,1", "1,7,nan,1,1",
                          "1,7,0.9,1,-1", "1,7,0.9,1,1\n1,8,0.9,1,1"})
    EXPECT_THROW(parse_numbers(head + row + "\n", "numbers.csv"), Error) << row;
  EXPECT_THROW(parse_numbers("id,number\n1,7\n", "numbers.csv"), Error);
  EXPECT_THROW(named("9,7,0.99,4,2.0\n", {"Reds"}), Error);
}

}  // namespace
}  // namespace marey::pipeline::identify
