#include "marey/format/match/ground_file.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"

#include "support/files.h"

namespace marey::format::match {
namespace {

TEST(GroundFile, WhatIsWrittenIsReadBack) {
  GroundRecording recording;
  recording.cameras = {"left", "right"};
  recording.people = {{3, "Anna, 7", "white"}, {1, "", ""}};
  recording.samples = {{0, 1, 0.0, {1.5, 2.25}, {0.5, -1}, 1, true},
                       {0, 0, 0.0, {10, 20}, {0, 0}, 3, true},
                       {1, 0, 0.04, {10.125, 20}, {3, 0}, 0, false}};
  const test::TemporaryFolder folder;
  write_ground(recording, folder / "match.csv");
  const GroundRecording read = read_ground(folder / "match.csv");
  ASSERT_EQ(read.samples.size(), 3u);
  EXPECT_EQ(read.cameras, recording.cameras);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto &a = read.samples[i], &b = recording.samples[i];
    const auto &p = read.people[a.person], &q = recording.people[b.person];
    EXPECT_EQ(a.frame, b.frame);
    EXPECT_EQ(a.place, b.place);
    EXPECT_EQ(a.velocity, b.velocity);
    EXPECT_EQ(a.cameras, b.cameras);
    EXPECT_EQ(a.observed, b.observed);
    EXPECT_EQ(p.id, q.id);
    EXPECT_EQ(p.label, q.label);
    EXPECT_EQ(p.team, q.team);
  }
  EXPECT_EQ(test::read_file(folder / "match.csv").substr(0, 55), "frame,time,id,label,team,x,y,vx,vy,state,cameras\n0,0.00");
}

TEST(GroundFile, OtherToolsNeedFewColumnsInAnyOrder) {
  const auto read = parse_ground("id,x,y,time,frame\n2,1,2,0.1,1\n1,3,4,0.0,0\n", "other.csv");
  ASSERT_EQ(read.samples.size(), 2u);
  EXPECT_EQ(read.samples[0].frame, 0);
  EXPECT_EQ(read.people[read.samples[1].person].id, 2);
  EXPECT_TRUE(read.people[0].team.empty());
}

TEST(GroundFile, FramesOrTimesAreEnough) {
  const auto frames = parse_ground("frame,id,x,y\n10,1,1,2\n20,1,1,2\n", "frames.csv", 50);
  EXPECT_DOUBLE_EQ(frames.samples[1].time, 0.4);
  const auto times = parse_ground("time,id,x,y\n0.4,1,1,2\n0.2,1,1,2\n1.0,1,1,2\n0.6,1,1,2\n", "times.csv");
  EXPECT_EQ(times.samples[0].frame, 1);
  EXPECT_EQ(times.samples[3].frame, 5);
}

TEST(GroundFile, WhatIsWrongIsSaidWithItsLine) {
  const auto message = [](const char* text) {
    try {
      parse_ground(text, "match.csv");
      return std::string();
    } catch (const Error& error) {
      return std::string(error.what());
    }
  };
  EXPECT_NE(message("").find("empty"), std::string::npos);
  EXPECT_NE(message("id,x,y\n").find("\"time\""), std::string::npos);
  EXPECT_NE(message("frame,x,y\n").find("\"id\""), std::string::npos);
  EXPECT_NE(message("frame,time,id,x,y\n0,0,1,nan,2\n").find("match.csv:2: x"), std::string::npos);
  EXPECT_NE(message("frame,time,id,x,y\n0,0,1,1,2\n0,0,1,1,2\n").find("twice"), std::string::npos);
  EXPECT_NE(message("frame,time,id,x,y,state\n0,0,1,1,2,lost\n").find("state"), std::string::npos);
  EXPECT_NE(message("frame,time,id,x,y\n0,0,0,1,2\n").find("id"), std::string::npos);
  EXPECT_EQ(message("frame,time,id,x,y\n"), "") << "nobody is no error";
}

}  // namespace
}  // namespace marey::format::match
