#include "wire.h"

#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace marey::viewer {
namespace {

template <typename T>
T value_at(const std::string& bytes, std::size_t at) {
  T value;
  EXPECT_LE(at + sizeof value, bytes.size());
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

Instant instant_of(std::int64_t index, double time_s) {
  Instant instant;
  instant.index = index;
  instant.time = timestamp_from_seconds(time_s);
  return instant;
}

Sample wired_row(int track, const Vector<3>& position, const std::optional<Box>& box = {}) {
  Sample row;
  row.track = TrackId{track};
  row.position = position;
  row.box = box;
  return row;
}

TEST(StreamProtocol, CamerasStandBeforeBodies) {
  Instant instant = instant_of(3, 0.1);
  instant.samples.push_back(wired_row(3, {1, 2, 3}));
  instant.samples.back().cameras = 0b1011;
  const std::string bytes = wire_of({&instant, 1}, 0, {.z = true, .boxes = false, .cameras = true});
  EXPECT_EQ(value_at<std::uint16_t>(bytes, 2), 1 | 4);
  EXPECT_EQ(value_at<float>(bytes, 40 + 8 + 12 + 12), 3.0F);             // z
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 40 + 8 + 12 + 16), 0b1011U);  // who saw it
  EXPECT_EQ(bytes.size(), 40U + 8 + 12 + 20 + 1);
}

TEST(StreamProtocol, AStretchLiesAsItsDescriptionSays) {
  std::vector<Instant> instants{instant_of(7, 0.5), instant_of(9, 1.25)};
  instants[0].samples.push_back(wired_row(3, {1, 2, 3}));
  instants[1].samples.push_back(wired_row(3, {4, 5, 6}));
  instants[1].samples.back().provenance = Provenance::filled;
  instants[1].samples.push_back(wired_row(8, {7, 8, 9}));
  BodyPose pose;
  pose.body = BodyId{2};
  pose.world_from_body.translation = {10, 11, 12};
  pose.tracked = false;
  instants[1].bodies.push_back(pose);
  const std::string bytes = wire_of(instants, 41, {.z = true, .boxes = false});
  EXPECT_EQ(bytes[0], 1);
  EXPECT_EQ(bytes[1], 1);
  EXPECT_EQ(value_at<std::uint16_t>(bytes, 2), 1);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 4), 41U);
  EXPECT_EQ(value_at<std::uint64_t>(bytes, 8), 500'000'000U);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 24), 2U);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 28), 3U);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 32), 1U);
  EXPECT_EQ(value_at<double>(bytes, 48), 1.25);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 60), 9U);         // index
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 64), 1U);         // row_end
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 68), 3U);         //
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 72), 0U);         // pose_end
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 76), 1U);         //
  EXPECT_EQ(value_at<std::int32_t>(bytes, 88), 8);           // track
  EXPECT_EQ(value_at<float>(bytes, 92), 1.0F);               // x
  EXPECT_EQ(value_at<float>(bytes, 112), 8.0F);              // y of the last
  EXPECT_EQ(value_at<float>(bytes, 124), 9.0F);              // z of the last
  EXPECT_EQ(value_at<std::int32_t>(bytes, 128), 2);          // body
  EXPECT_EQ(value_at<float>(bytes, 140), 12.0F);             // pz
  EXPECT_EQ(value_at<float>(bytes, 156), 1.0F);              // qw
  EXPECT_EQ(bytes.substr(160), std::string("\0\1\0\0", 4));  // states, tracked
}

TEST(StreamProtocol, BoxesOfThoseThatHaveOne) {
  Instant instant = instant_of(0, 0);
  instant.samples.push_back(wired_row(1, {1, 2, 0}, Box{10, 20, 30, 40}));
  instant.samples.push_back(wired_row(2, {3, 4, 0}));
  const std::string bytes = wire_of(instant, 5, {.z = false, .boxes = true}, 77);
  EXPECT_EQ(bytes[0], 2);
  EXPECT_EQ(value_at<std::uint16_t>(bytes, 2), 2);
  EXPECT_EQ(value_at<std::uint64_t>(bytes, 16), 77U);
  ASSERT_EQ(bytes.size(), 40U + 8 + 4 + 4 + 4 + 2 * (4 + 2 * 4 + 4 * 4) + 2);
  EXPECT_EQ(value_at<float>(bytes, 84), 10.0F);  // left of the first
  EXPECT_EQ(value_at<float>(bytes, 108), 40.0F);
  EXPECT_EQ(bytes[bytes.size() - 2], 8);
  EXPECT_EQ(bytes[bytes.size() - 1], 0);
}

TEST(StreamProtocol, APictureBringsWhatItsOwnCameraSaw) {
  const std::vector<ImageObservation> detected{
      {.camera = CameraId{1}, .pixel = {5, 6}, .sigma = {}, .area = {}, .track = TrackId{4}},
      {.camera = CameraId{0}, .pixel = {7, 8}, .sigma = {}, .area = {}, .track = {}}};
  const std::vector<BoxInView> boxes{
      {.camera = CameraId{1}, .frame = 0, .track = TrackId{9}, .box = {1, 2, 3, 4}, .foot = {}, .detected = true}};
  const std::string bytes = wire_of({.camera = CameraId{1},
                                     .frame = 12,
                                     .time = {},
                                     .sent_ns = 0,
                                     .size = {640, 480},
                                     .detected = detected,
                                     .boxes = boxes,
                                     .jpeg = "JPEG"});
  EXPECT_EQ(bytes[0], 3);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 4), 12U);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 24), 1U);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 28), 1U);
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 32), 1U);
  EXPECT_EQ(value_at<std::uint16_t>(bytes, 36), 640);
  EXPECT_EQ(value_at<std::uint16_t>(bytes, 38), 480);
  EXPECT_EQ(value_at<float>(bytes, 44), 6.0F);
  EXPECT_EQ(value_at<std::int32_t>(bytes, 48), 4);
  EXPECT_EQ(value_at<float>(bytes, 64), 4.0F);
  EXPECT_EQ(value_at<std::int32_t>(bytes, 68), 9);
  EXPECT_EQ(bytes.substr(72), "JPEG");
}

}  // namespace
}  // namespace marey::viewer
