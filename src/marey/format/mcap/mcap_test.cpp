#include "marey/format/mcap/mcap.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/mcap/foxglove_messages.h"
#include "marey/format/mcap/foxglove_schemas.h"
#include "marey/format/mcap/protobuf.h"
#include "marey/format/register.h"

#include "support/files.h"

namespace marey::format::mcap {
namespace {

RecordingHeader header_with_body() {
  RecordingHeader header;
  header.rate_hz = 100;
  Body& racket = header.bodies.emplace_back();
  racket.id = BodyId(1);
  racket.label = "racket";
  return header;
}

Instant instant_at(std::int64_t index) {
  Instant instant;
  instant.index = index;
  instant.time = Timestamp(std::chrono::milliseconds(10 * index));
  Sample& point = instant.samples.emplace_back();
  point.track = TrackId(3);
  point.position = {1, 2, 3};
  BodyPose& pose = instant.bodies.emplace_back();
  pose.body = BodyId(1);
  pose.world_from_body.translation = {4, 5, 6};
  if (index == 0) instant.named.push_back({.id = TrackId(3), .label = "LASI", .team = {}});
  return instant;
}

std::string written(const std::string& path, int frames) {
  const auto sink = create_mcap(path, {});
  sink->begin(header_with_body());
  for (int i = 0; i < frames; ++i) sink->write(instant_at(i));
  sink->finish();
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(Protobuf, TagsAndNumbersAsTheEncodingHasThem) {
  EXPECT_EQ(ProtobufWriter().varint(1, 150).str(), "\x08\x96\x01");
  EXPECT_EQ(ProtobufWriter().bytes(2, "testing").str(), "\x12\x07testing");
  EXPECT_EQ(ProtobufWriter().message(3, ProtobufWriter().varint(1, 150)).str(), "\x1a\x03\x08\x96\x01");
  EXPECT_EQ(ProtobufWriter().fixed32(1, 1).str(), std::string("\x0d\x01\0\0\0", 5));
}

TEST(Mcap, AFileIsWholeAndItsSummaryTellsWhatIsInIt) {
  const test::TemporaryFolder folder;
  const std::string bytes = written(folder / "a.mcap", 50);
  EXPECT_TRUE(bytes.starts_with("\x89MCAP0\r\n"));
  EXPECT_TRUE(bytes.ends_with("\x89MCAP0\r\n"));
  const auto facts = mcap_facts(bytes, "a.mcap");
  ASSERT_EQ(facts.size(), 3u);
  EXPECT_EQ(std::get<std::int64_t>(facts[0].value), 200);  // points, transforms, scene, times
  EXPECT_EQ(std::get<std::int64_t>(facts[1].value), 4);
  EXPECT_DOUBLE_EQ(std::get<double>(facts[2].value), 0.49);
  const Format* known = format_of_content(folder / "a.mcap");
  ASSERT_NE(known, nullptr);
  EXPECT_EQ(known->name, "mcap");
  EXPECT_EQ(format_to_write("b.mcap", "", Content::ground).name, "mcap");
}

TEST(Mcap, TheSameRecordingGivesTheSameBytes) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(written(folder / "a.mcap", 20), written(folder / "b.mcap", 20));
}

TEST(Mcap, ReportsTruncationAnywhere) {
  const test::TemporaryFolder folder;
  const std::string bytes = written(folder / "a.mcap", 3);
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    EXPECT_THROW(mcap_facts(std::string_view(bytes).substr(0, size), "a.mcap"), Error) << size;
    const std::string with_end = bytes.substr(0, size) + bytes.substr(bytes.size() - 37);
    try {
      mcap_facts(with_end, "a.mcap");
    } catch (const Error& error) {
      EXPECT_TRUE(std::string_view(error.what()).starts_with("a.mcap: "));
    }
  }
}

TEST(Mcap, WithoutFinishNothingIsLeft) {
  const test::TemporaryFolder folder;
  {
    const auto sink = create_mcap(folder / "a.mcap", {});
    sink->begin(header_with_body());
    sink->write(instant_at(0));
  }
  EXPECT_FALSE(std::ifstream(folder / "a.mcap").good());
}

TEST(FoxgloveMessages, APointCloudHoldsPlacesAndNumbers) {
  FoxgloveMessages messages;
  messages.begin(header_with_body());
  const Instant instant = instant_at(0);
  messages.add(instant.named);
  const std::string cloud = messages.message(kPointsTopic, instant, {.stamp = 1'500'000'000});
  // One second and a half, and at the end 16 bytes: 1, 2, 3 as floats and the track's number.
  EXPECT_TRUE(cloud.starts_with(std::string("\x0a\x08\x08\x01\x10\x80\xca\xb5\xee\x01\x12\x05world", 17)));
  EXPECT_TRUE(cloud.ends_with(std::string("\x32\x10\0\0\x80\x3f\0\0\0\x40\0\0\x40\x40\x03\0\0\0", 18)));
  EXPECT_NE(messages.message(kSceneTopic, instant, {}).find("LASI"), std::string::npos);
  EXPECT_NE(messages.message(kTransformsTopic, instant, {}).find("racket"), std::string::npos);
  EXPECT_EQ(messages.message(kTimesTopic, instant, {.stamp = 0, .capture = 1, .solve = 2, .send = 3}),
            R"({"frame":0,"time":0.000000000,"capture_ns":1,"solve_ns":2,"send_ns":3})");
}

TEST(FoxgloveSchemas, TheDescriptorsNameEveryMessage) {
  for (const char* name : {"PointCloud", "FrameTransforms", "SceneUpdate", "NumericType", ".google.protobuf.Timestamp"})
    EXPECT_NE(foxglove_descriptors().find(name), std::string::npos) << name;
}

}  // namespace
}  // namespace marey::format::mcap
