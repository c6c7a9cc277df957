#include "marey/format/tracks/track_file.h"

#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "marey/core/error.h"

#include "support/files.h"

namespace marey::format::tracks {
namespace {

RecordingHeader in_pictures() {
  RecordingHeader header;
  header.frame.kind = FrameOfReference::Kind::image;
  return header;
}

Instant two_tracks() {
  Sample seen;
  seen.track = TrackId{3};
  seen.position = {12.5, 30, 0};
  seen.velocity = Vector<3>(-1.25, 0, 0);
  seen.box = Box{9, 20, 8, 21};
  seen.score = 0.75;
  Sample guessed;
  guessed.track = TrackId{4};
  guessed.position = {1, 2, 0};
  guessed.provenance = Provenance::predicted;
  Instant instant;
  instant.index = 6;
  instant.time = timestamp_from_seconds(0.24);
  instant.samples = {seen, guessed};
  instant.named = {{TrackId{4}, "the \"tall\", one", {}}};
  return instant;
}

TEST(TrackFile, JsonLinesHoldOutlinesWhole) {
  Instant instant = two_tracks();
  auto outline = std::make_shared<Outline>();
  outline->order = 3;
  outline->state = Outline::State::partly;
  outline->control_points = {{1, 2}, {3.25, 4}, {5, 6.5}};
  outline->deviations = {{0.5, 0.25}, {1, 1}, {2, 3}};
  outline->centre = {3, 4};
  outline->velocity = {10, -20};
  outline->scale_rate = 0.125;
  outline->silhouette = Vector<2>(3.5, 4.25);
  outline->velocity_deviation = {1.5, 2};
  outline->scale_rate_deviation = 0.0625;
  instant.samples[0].outline = outline;
  instant.samples.pop_back();
  const test::TemporaryFolder folder;
  TrackFile file(folder / "tracks", TrackText::jsonl);
  file.begin(in_pictures());
  file.write(instant);
  file.finish();
  const auto json = nlohmann::json::parse(test::read_file(folder / "tracks"))["outline"];
  EXPECT_EQ(json["state"], "partly");
  EXPECT_EQ(json["order"], 3);
  EXPECT_EQ(json["control_points"], nlohmann::json::parse("[[1.0,2.0],[3.25,4.0],[5.0,6.5]]"));
  EXPECT_EQ(json["deviations"], nlohmann::json::parse("[[0.5,0.25],[1.0,1.0],[2.0,3.0]]"));
  EXPECT_EQ(json["centre"], nlohmann::json::parse("[3.0,4.0]"));
  EXPECT_EQ(json["velocity"], nlohmann::json::parse("[10.0,-20.0]"));
  EXPECT_EQ(json["scale_rate"], 0.125);
  EXPECT_EQ(json["silhouette"], nlohmann::json::parse("[3.5,4.25]"));
  EXPECT_EQ(json["centre_deviation"], nlohmann::json::parse("[0.0,0.0]"));
  EXPECT_EQ(json["velocity_deviation"], nlohmann::json::parse("[1.5,2.0]"));
  EXPECT_EQ(json["scale_rate_deviation"], 0.0625);
}

std::string written(TrackText format) {
  const test::TemporaryFolder folder;
  TrackFile file(folder / "tracks", format);
  file.begin(in_pictures());
  file.write({});
  file.write(two_tracks());
  file.finish();
  return test::read_file(folder / "tracks");
}

TEST(TrackFile, MotCountsFramesAndPixelsFromOneAndHoldsBoxesAlone) {
  EXPECT_EQ(written(TrackText::mot), "7,3,10.00,21.00,8.00,21.00,0.75,-1,-1,-1\n");
}

TEST(TrackFile, CsvHasAHeaderAndLeavesEmptyWhatIsMissing) {
  EXPECT_EQ(written(TrackText::csv),
            "frame,time,id,label,x,y,vx,vy,left,top,width,height,state\n"
            "6,0.240000,3,,12.500,30.000,-1.25,0.00,9.00,20.00,8.00,21.00,observed\n"
            "6,0.240000,4,\"the \"\"tall\"\", one\",1.000,2.000,,,,,,,predicted\n");
}

TEST(TrackFile, PositionsInMetresAreRefused) {
  const test::TemporaryFolder folder;
  TrackFile file(folder / "tracks", TrackText::csv);
  RecordingHeader header = in_pictures();
  header.frame.kind = FrameOfReference::Kind::ground;
  EXPECT_THROW(file.begin(header), Error);
}

TEST(TrackFile, EveryJsonLineIsAnObject) {
  std::istringstream lines(written(TrackText::jsonl));
  std::vector<nlohmann::json> objects;
  for (std::string line; std::getline(lines, line);) objects.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(objects.size(), 2u);
  EXPECT_EQ(objects[0]["frame"], 6);
  EXPECT_EQ(objects[0]["time"], 0.24);
  EXPECT_EQ(objects[0]["height"], 21);
  EXPECT_EQ(objects[0]["state"], "observed");
  EXPECT_FALSE(objects[0].contains("label"));
  EXPECT_EQ(objects[1]["label"], "the \"tall\", one");
  EXPECT_FALSE(objects[1].contains("left"));
}

}  // namespace
}  // namespace marey::format::tracks
