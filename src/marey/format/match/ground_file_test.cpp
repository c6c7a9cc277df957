#include "marey/format/match/ground_file.h"

#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/core/ground_transform.h"

#include "support/files.h"

namespace marey::format::match {
namespace {

Sample sample_of(int track, const Vector<2>& location, const Vector<2>& velocity, CameraMask cameras, bool detected) {
  Sample sample;
  sample.track = TrackId{track};
  sample.position.head<2>() = location;
  sample.velocity = Vector<3>(velocity.x(), velocity.y(), 0);
  sample.cameras = cameras;
  sample.provenance = detected ? Provenance::measured : Provenance::predicted;
  return sample;
}

RecordingHeader two_cameras() {
  RecordingHeader header;
  header.frame.kind = FrameOfReference::Kind::user_ground;
  header.rate_hz = 25;
  header.rig.emplace();
  for (const char* camera : {"left", "right"}) header.rig->cameras.emplace_back().name = camera;
  return header;
}

TEST(GroundFile, RoundTripsContent) {
  Recording recording(two_cameras());
  Instant first, second;
  first.samples = {sample_of(1, {1.5, 2.25}, {0.5, -1}, 1, true), sample_of(3, {10, 20}, {0, 0}, 3, true)};
  first.named = {{TrackId{3}, "Anna, 7", "white"}};
  second.index = 1;
  second.time = timestamp_from_seconds(0.04);
  second.samples = {sample_of(3, {10.125, 20}, {3, 0}, 0, false)};
  recording.add(first);
  recording.add(second);
  const test::TemporaryFolder folder;
  write_ground(recording, folder / "match.csv");
  const Recording read = read_ground(folder / "match.csv");
  EXPECT_EQ(read.header.rate_hz, 25);
  EXPECT_EQ(read.header.frame.kind, FrameOfReference::Kind::user_ground);
  ASSERT_TRUE(read.header.rig);
  ASSERT_EQ(read.header.rig->cameras.size(), 2u);
  EXPECT_EQ(read.header.rig->cameras[1].name, "right");
  InstantsOf are(read), were(recording);
  for (int i = 0; i < 2; ++i) {
    const Instant is = *are.next(), was = *were.next();
    EXPECT_EQ(is.index, was.index);
    EXPECT_EQ(is.time, was.time);
    EXPECT_EQ(is.named, was.named);
    ASSERT_EQ(is.samples.size(), was.samples.size());
    for (std::size_t k = 0; k < is.samples.size(); ++k) {
      EXPECT_EQ(is.samples[k].track, was.samples[k].track);
      EXPECT_EQ(is.samples[k].position, was.samples[k].position);
      EXPECT_EQ(is.samples[k].velocity, was.samples[k].velocity);
      EXPECT_EQ(is.samples[k].cameras, was.samples[k].cameras);
      EXPECT_EQ(is.samples[k].provenance, was.samples[k].provenance);
    }
  }
  EXPECT_EQ(test::read_file(folder / "match.csv").substr(0, 55), "frame,time,id,label,team,x,y,vx,vy,state,cameras\n0,0.00");
}

TEST(GroundFile, HowWellPlacesAreKnownIsKept) {
  RecordingHeader header;
  header.frame.kind = FrameOfReference::Kind::user_ground;
  Recording recording(header);
  for (int i = 0; i < 3; ++i) {
    Instant instant;
    instant.index = i;
    instant.time = timestamp_from_seconds(0.04 * i);
    instant.samples = {sample_of(1, {10.0 + i, 20}, {3, 0}, 0, true)};
    if (i > 0) instant.samples[0].covariance.emplace(Matrix<3>::Zero()).topLeftCorner<2, 2>() << 0.04, -0.01, -0.01, 0.25;
    if (i == 2) {
      instant.named.push_back({TrackId{2}, std::string(kBallLabel), "", {}, TrackKind::ball});
      instant.samples.push_back(sample_of(2, {11, 20}, {0, 0}, 0, true));
    }
    recording.add(instant);
  }
  const test::TemporaryFolder folder;
  write_ground(recording, folder / "match.csv");
  EXPECT_NE(test::read_file(folder / "match.csv").find("state,cameras,xx,xy,yy,z,vz\n"), std::string::npos);
  const Recording read = read_ground(folder / "match.csv");
  ASSERT_EQ(read.tracks()[0].size(), 3u);
  EXPECT_FALSE(read.tracks()[0].sample(0).covariance);
  for (const std::size_t row : {1u, 2u})
    EXPECT_EQ(read.tracks()[0].sample(row).covariance, recording.tracks()[0].sample(row).covariance);
  EXPECT_THROW(parse_ground("frame,id,x,y,xx,xy,yy\n0,1,1,2,0.01,0.5,0.01\n", "wrong.csv"), Error);
}

TEST(GroundFile, AReflectedGroundIsStatedAndReadBack) {
  RecordingHeader header = two_cameras();
  header.rig->ground_from_world = Matrix<3>{{1, 0, 52.5}, {0, -1, 34}, {0, 0, 1}};
  Recording recording(header);
  Instant instant;
  instant.samples = {sample_of(1, {1.5, 2.25}, {0.5, -1}, 1, true)};
  recording.add(instant);
  const test::TemporaryFolder folder;
  write_ground(recording, folder / "match.csv");
  const std::string text = test::read_file(folder / "match.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')), "frame,time,id,label,team,x,y,vx,vy,state,cameras,y_down");
  EXPECT_EQ(text.substr(text.size() - 8), ",left,1\n");
  EXPECT_TRUE(y_grows_down(read_ground(folder / "match.csv").header));
  EXPECT_TRUE(y_grows_down(parse_ground("frame,id,x,y,y_down\n0,1,1,2,1\n1,1,1,2,1\n", "other.csv").header));
  EXPECT_FALSE(y_grows_down(parse_ground("frame,id,x,y,y_down\n0,1,1,2,0\n", "other.csv").header));
  EXPECT_THROW(parse_ground("frame,id,x,y,y_down\n0,1,1,2,1\n1,1,1,2,0\n", "both.csv"), Error);
  EXPECT_THROW(parse_ground("frame,id,x,y,y_down\n0,1,1,2,0.5\n", "half.csv"), Error);
}

TEST(GroundFile, OtherToolsNeedFewColumnsInAnyOrder) {
  const Recording read = parse_ground("id,x,y,time,frame\n2,1,2,0.1,1\n1,3,4,0.0,0\n", "other.csv");
  ASSERT_EQ(read.tracks().size(), 2u);
  EXPECT_EQ(read.instants()[0].index, 0);
  EXPECT_EQ(number(read.tracks()[1].id()), 2);
  EXPECT_EQ(read.tracks()[1].at()[0], 1);
  EXPECT_TRUE(read.tracks()[0].name.team.empty());
  EXPECT_FALSE(has_velocities(read));
}

TEST(GroundFile, RowsByPersonAreTheSameAsRowsByFrame) {
  const Recording by_frame = parse_ground("frame,id,x,y\n0,4,1,2\n0,9,5,6\n1,9,7,8\n3,4,3,4\n", "f.csv");
  const Recording by_person = parse_ground("frame,id,x,y\n1,9,7,8\n0,9,5,6\n0,4,1,2\n3,4,3,4\n", "p.csv");
  ASSERT_EQ(by_frame.instants().size(), 3u);
  ASSERT_EQ(by_person.instants().size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(by_frame.instants()[i].index, by_person.instants()[i].index);
    EXPECT_EQ(by_frame.instants()[i].time, by_person.instants()[i].time);
  }
  for (std::size_t t = 0; t < 2; ++t) {
    const TrackColumns &a = by_frame.tracks()[t], &b = by_person.tracks()[t];
    ASSERT_EQ(a.size(), 2u);
    ASSERT_EQ(b.size(), 2u);
    for (std::size_t row = 0; row < 2; ++row) {
      EXPECT_EQ(a.at()[row], b.at()[row]);
      EXPECT_EQ(a.location(row), b.location(row));
    }
  }
}

TEST(GroundFile, VelocitiesThatAreMissingAreNotKnown) {
  EXPECT_FALSE(has_velocities(parse_ground("frame,id,x,y,vx,vy\n0,1,1,2,0,0\n1,1,1,2,0,0\n", "still.csv")));
  const Recording some = parse_ground("frame,id,x,y,vx,vy\n0,1,1,2,0,0\n1,1,1,2,,\n2,1,1,2,1,0\n", "some.csv");
  const TrackColumns& track = some.tracks()[0];
  EXPECT_EQ(track.velocity(0), Vector<3>(0, 0, 0));
  EXPECT_FALSE(track.velocity(1));
  EXPECT_EQ(track.velocity(2), Vector<3>(1, 0, 0));
}

TEST(GroundFile, TheRateIsThatOfTheUsualStep) {
  std::string text = "frame,time,id,x,y\n";
  for (int frame = 0; frame < 300; ++frame) {
    if (frame > 100 && frame < 130) continue;
    // At 30 Hz, rounded as we write it; one time is wrong, and the clock jumps by 2 s in the gap.
    const double time = frame / 30.0 + (frame > 115 ? 2 : 0) + (frame == 50 ? 0.02 : 0);
    text += fmt::format("{},{:.4f},1,5,5\n", frame, time);
  }
  EXPECT_NEAR(parse_ground(text, "jumps.csv").header.rate_hz, 30, 0.002);
  EXPECT_EQ(parse_ground("frame,time,id,x,y\n7,1,1,5,5\n", "one.csv").header.rate_hz, 25);
}

TEST(GroundFile, TracksInAPictureAreInPixels) {
  const Recording read = parse_ground(
      "frame,time,id,label,x,y,vx,vy,left,top,width,height,state\n0,0,1,,400,300,10,0,390,260,20,40,observed\n", "tracks.csv");
  EXPECT_EQ(read.header.frame.kind, FrameOfReference::Kind::image);
  EXPECT_THROW(require_ground(read, "measuring"), Error);
  const test::TemporaryFolder folder;
  EXPECT_THROW(write_ground(read, folder / "match.csv"), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(GroundFile, AWriterThatDoesNotFinishLeavesNothing) {
  const test::TemporaryFolder folder;
  {
    GroundWriter writer(folder / "match.csv");
    writer.begin(two_cameras());
    Instant instant;
    instant.samples = {sample_of(1, {1, 2}, {0, 0}, 1, true)};
    writer.write(instant);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(GroundFile, FramesOrTimesAreEnough) {
  const Recording frames = parse_ground("frame,id,x,y\n10,1,1,2\n20,1,1,2\n", "frames.csv", 50);
  EXPECT_DOUBLE_EQ(frames.seconds_at(1), 0.4);
  const Recording times = parse_ground("time,id,x,y\n0.4,1,1,2\n0.2,1,1,2\n1.0,1,1,2\n0.6,1,1,2\n", "times.csv");
  EXPECT_EQ(times.instants()[0].index, 1);
  EXPECT_EQ(times.instants()[3].index, 5);
}

TEST(GroundFile, ReportsErrorWithLine) {
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
  EXPECT_EQ(message("frame,time,id,x,y\n"), "") << "no person is not an error";
}

TEST(GroundFile, ReportsOutlierFrame) {
  try {
    parse_ground("frame,id,x,y\n0,1,2,3\n1,1,2,3\n999999999,1,2,3\n", "m.csv");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "m.csv: frames 0 to 999999999 are named, of which 3 are there; a number must be wrong");
  }
}

}  // namespace
}  // namespace marey::format::match
