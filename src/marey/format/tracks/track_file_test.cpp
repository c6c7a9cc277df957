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

RecordingHeader in_images() {
  RecordingHeader header;
  header.frame.kind = FrameOfReference::Kind::image;
  return header;
}

Instant two_tracks() {
  Sample detected;
  detected.track = TrackId{3};
  detected.position = {12.5, 30, 0};
  detected.velocity = Vector<3>(-1.25, 0, 0);
  detected.box = Box{9, 20, 8, 21};
  detected.score = 0.75;
  Sample guessed;
  guessed.track = TrackId{4};
  guessed.position = {1, 2, 0};
  guessed.provenance = Provenance::predicted;
  Instant instant;
  instant.index = 6;
  instant.time = timestamp_from_seconds(0.24);
  instant.samples = {detected, guessed};
  instant.named = {{TrackId{4}, "the \"tall\", one", {}}};
  return instant;
}

/// A person with a nose, whose left eye was not found.
Instant any_person() {
  auto body = std::make_shared<Keypoints<2>>();
  body->presence = 0.875;
  body->points.resize(2);
  body->points[0] = Keypoint<2>{.position = {10.25, 20}, .covariance = Matrix<2>::Identity() * 4, .visibility = 0.5, .presence = 1};
  Instant instant = two_tracks();
  instant.samples[0].keypoints = body;
  return instant;
}

RecordingHeader with_keypoints() {
  RecordingHeader header = in_images();
  header.keypoints = KeypointSet{.name = "two", .points = {"nose", "left_eye"}, .bones = {{0, 1}}, .mirrored = {0, 1}};
  return header;
}

TEST(TrackFile, KeypointsAreARowEach) {
  const test::TemporaryFolder folder;
  TrackFile file(folder / "points.csv", TrackText::csv);
  file.begin(with_keypoints());
  file.write(any_person());
  file.finish();
  EXPECT_EQ(test::read_file(folder / "points.csv"),
            "frame,time,id,point,x,y,sd,visibility,presence\n6,0.240000,3,nose,10.250,20.000,2.000,0.5000,1.0000\n");
}

TEST(TrackFile, JsonLinesHoldKeypoints) {
  const test::TemporaryFolder folder;
  TrackFile file(folder / "points.jsonl", TrackText::jsonl);
  file.begin(with_keypoints());
  file.write(any_person());
  file.finish();
  std::istringstream lines(test::read_file(folder / "points.jsonl"));
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  const auto json = nlohmann::json::parse(line);
  EXPECT_EQ(json.at("keypoints").dump(), R"({"points":{"nose":[10.25,20.0,2.0,0.5,1.0]},"presence":0.875})");
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_FALSE(nlohmann::json::parse(line).contains("keypoints"));
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
  file.begin(in_images());
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
  file.begin(in_images());
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
            "6,0.240000,3,,12.500,30.000,-1.25,0.00,9.00,20.00,8.00,21.00,measured\n"
            "6,0.240000,4,\"the \"\"tall\"\", one\",1.000,2.000,,,,,,,predicted\n");
}

TEST(TrackFile, PositionsInMetresAreRefused) {
  const test::TemporaryFolder folder;
  TrackFile file(folder / "tracks", TrackText::csv);
  RecordingHeader header = in_images();
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
  EXPECT_EQ(objects[0]["state"], "measured");
  EXPECT_FALSE(objects[0].contains("label"));
  EXPECT_EQ(objects[1]["label"], "the \"tall\", one");
  EXPECT_FALSE(objects[1].contains("left"));
}

}  // namespace
}  // namespace marey::format::tracks
