#include <cmath>

#include <gtest/gtest.h>

#include "marey/stream/bytes.h"
#include "marey/stream/natnet_packets.h"

#include "support/moving_bodies.h"

namespace marey::stream {
namespace {

/// Reads the written bytes, in order, and fails beyond the end.
class NatNetReader {
 public:
  explicit NatNetReader(std::string_view bytes, std::size_t at = 4) : bytes_(bytes), at_(at) {}
  template <typename T>
  T next() {
    const auto value = number_at<T>(bytes_, at_);
    EXPECT_TRUE(value);
    at_ += sizeof(T);
    return value.value_or(T{});
  }
  std::string text() {
    const std::size_t end = bytes_.find('\0', at_);
    std::string text(bytes_.substr(at_, end - at_));
    at_ = end + 1;
    return text;
  }
  /// A section's count; `end` is where it ends.
  int section(std::size_t& end) {
    const int count = next<std::int32_t>();
    const int size = next<std::int32_t>();
    end = at_ + static_cast<std::size_t>(size);
    return count;
  }
  Vector<3> vector() {
    const float x = next<float>(), y = next<float>(), z = next<float>();
    return {x, y, z};
  }
  std::size_t at() const { return at_; }
  void skip_to(std::size_t at) { at_ = at; }

 private:
  std::string_view bytes_;
  std::size_t at_;
};

ChannelLayout layout_of_bodies() {
  ChannelLayout channel_layout;
  channel_layout.begin(test::header_of_moving_bodies());
  channel_layout.add(test::moving_bodies(0).named);
  return channel_layout;
}

TEST(NatNet, AFrameReadsSectionBySection) {
  const ChannelLayout channel_layout = layout_of_bodies();
  const Instant instant = test::moving_bodies(10);
  ChannelLayout::Scene scene;
  channel_layout.location(instant, scene);
  const std::string frame = natnet_frame(channel_layout, scene, instant, {.capture = 1, .solve = 2, .send = 3});
  EXPECT_EQ(*number_at<std::uint16_t>(frame, 0), 7);
  EXPECT_EQ(*number_at<std::uint16_t>(frame, 2), frame.size() - 4);
  NatNetReader reader(frame);
  std::size_t end = 0;
  EXPECT_EQ(reader.next<std::int32_t>(), 10);
  EXPECT_EQ(reader.section(end), 1);  // marker sets
  EXPECT_EQ(reader.text(), "Markers");
  EXPECT_EQ(reader.next<std::int32_t>(), 2);
  EXPECT_LT((reader.vector() - Vector<3>(0.01, 1, 0)).norm(), 1e-6);  // y is up
  EXPECT_TRUE(std::isnan(reader.next<float>()));
  EXPECT_EQ(reader.at() + 8, end);
  reader.skip_to(end);
  EXPECT_EQ(reader.section(end), 1);  // without label
  EXPECT_LT((reader.vector() - Vector<3>(1, 3, -2)).norm(), 1e-6);
  EXPECT_EQ(reader.section(end), 1);  // bodies
  EXPECT_EQ(reader.next<std::int32_t>(), 1);
  EXPECT_LT((reader.vector() - Vector<3>(0, 1.5, -0.01)).norm(), 1e-6);
  EXPECT_LT((reader.vector() - Vector<3>(0, std::sin(0.05), 0)).norm(), 1e-6);
  EXPECT_NEAR(reader.next<float>(), std::cos(0.05), 1e-6);
  EXPECT_NEAR(reader.next<float>(), 0.001, 1e-7);
  EXPECT_EQ(reader.next<std::int16_t>(), 1);  // tracked
  EXPECT_EQ(reader.at(), end);
  EXPECT_EQ(reader.section(end), 1);  // skeletons
  EXPECT_EQ(reader.next<std::int32_t>(), 1);
  EXPECT_EQ(reader.next<std::int32_t>(), 2);
  EXPECT_EQ(reader.next<std::int32_t>(), 1 << 16 | 1);
  reader.skip_to(end);
  EXPECT_EQ(reader.section(end), 0);  // assets
  EXPECT_EQ(reader.section(end), 2);  // markers
  EXPECT_EQ(reader.next<std::int32_t>(), 1);
  reader.skip_to(reader.at() + 16);
  EXPECT_EQ(reader.next<std::int16_t>(), 2);  // seen by cameras
  EXPECT_NEAR(reader.next<float>(), 0.0005, 1e-7);
  EXPECT_EQ(reader.next<std::int32_t>(), 3);
  reader.skip_to(reader.at() + 16);
  EXPECT_EQ(reader.next<std::int16_t>(), 16 | 1);  // no label, predicted
  reader.skip_to(end);
  EXPECT_EQ(reader.section(end), 0);
  EXPECT_EQ(reader.section(end), 0);
  reader.skip_to(reader.at() + 8);
  EXPECT_DOUBLE_EQ(reader.next<double>(), 0.1);
  for (const std::uint64_t ticks : {1, 2, 3}) EXPECT_EQ(reader.next<std::uint64_t>(), ticks);
  EXPECT_EQ(reader.at() + 8 + 2 + 4, frame.size());
}

TEST(NatNet, DefinitionsNameMarkersBodiesAndBones) {
  const std::string bytes = natnet_definitions(layout_of_bodies());
  NatNetReader reader(bytes);
  EXPECT_EQ(reader.next<std::int32_t>(), 3);
  std::size_t end = 0;
  EXPECT_EQ(reader.section(end), 0);
  EXPECT_EQ(reader.text(), "Markers");
  EXPECT_EQ(reader.next<std::int32_t>(), 2);
  EXPECT_EQ(reader.text(), "LASI");
  EXPECT_EQ(reader.text(), "RASI");
  EXPECT_EQ(reader.at(), end);
  EXPECT_EQ(reader.section(end), 1);
  EXPECT_EQ(reader.text(), "racket");
  EXPECT_EQ(reader.next<std::int32_t>(), 1);
  EXPECT_EQ(reader.next<std::int32_t>(), -1);
  reader.vector();
  EXPECT_EQ(reader.next<std::int32_t>(), 2);
  EXPECT_LT((reader.vector() - Vector<3>(0.1, 0, 0)).norm(), 1e-6);
  reader.skip_to(end);
  EXPECT_EQ(reader.section(end), 2);
  EXPECT_EQ(reader.text(), "dancer");
  EXPECT_EQ(end, bytes.size());
}

TEST(NatNet, AnswersAreWhatClientsWaitFor) {
  EXPECT_EQ(natnet_response(std::string_view("Bitstream\0", 10)).substr(4), std::string("Bitstream,4.1\0", 14));
  EXPECT_EQ(natnet_response("FrameRate").substr(4), std::string(4, '\0'));
  const std::string info = natnet_server_info(1511, 0xefff2a63);
  EXPECT_EQ(info.size(), 4u + 256 + 8 + 8 + 2 + 1 + 4);
  EXPECT_EQ(info.substr(4, 6), std::string("Marey\0", 6));
  EXPECT_EQ(info.substr(264, 2), "\x04\x01");
  EXPECT_EQ(info.substr(info.size() - 7), std::string("\xe7\x05\x01\xef\xff\x2a\x63", 7));
  EXPECT_TRUE(natnet_message(NatNetMessage::frame, std::string(70'000, 'x')).empty());
  EXPECT_FALSE(natnet_received("\x01\0"));
  EXPECT_EQ(natnet_received(std::string_view("\x0a\0\0\0x", 5))->payload, "x");
}

}  // namespace
}  // namespace marey::stream
