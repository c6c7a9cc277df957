#include <cmath>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/stream/bytes.h"
#include "marey/stream/qtm_session.h"

#include "support/moving_bodies.h"

namespace marey::stream {
namespace {

struct QtmScene {
  RecordingHeader header = test::header_of_moving_bodies();
  ChannelLayout channel_layout;
  QtmState state;
  Instant instant;

  explicit QtmScene(int k = 1) : instant(test::moving_bodies(k)) {
    channel_layout.begin(header);
    channel_layout.add(test::moving_bodies(0).named);
    state.header = &header;
    state.channel_layout = &channel_layout;
  }
  std::string packet(const std::vector<QtmComponent>& required, bool global = false) const {
    ChannelLayout::Scene scene;
    channel_layout.location(instant, scene);
    return qtm_data_packet(channel_layout, scene, instant, {.required = required, .global_skeletons = global});
  }
};

float float_at(const std::string& bytes, std::size_t at) {
  return *number_at<float>(bytes, at);
}
std::uint32_t word_at(const std::string& bytes, std::size_t at) {
  return *number_at<std::uint32_t>(bytes, at);
}

std::string text_of_reply(const std::vector<std::string>& replies) {
  if (replies.empty()) return "nothing";
  EXPECT_EQ(word_at(replies[0], 0), replies[0].size());
  EXPECT_EQ(replies[0].back(), '\0');
  return std::to_string(word_at(replies[0], 4)) + " " + replies[0].substr(8, replies[0].size() - 9);
}

TEST(Qtm, ADataPacketHasItsHeadAndPointsInMillimetres) {
  const std::string packet = QtmScene(1).packet({QtmComponent::points});
  ASSERT_EQ(packet.size(), 24u + 8 + 8 + 2 * 12);
  EXPECT_EQ(word_at(packet, 0), packet.size());
  EXPECT_EQ(word_at(packet, 4), 3u);
  EXPECT_EQ(*number_at<std::int64_t>(packet, 8), 10'000);  // µs
  EXPECT_EQ(word_at(packet, 16), 2u);                      // frames count from 1
  EXPECT_EQ(word_at(packet, 20), 1u);                      // components
  EXPECT_EQ(word_at(packet, 24), 40u);
  EXPECT_EQ(word_at(packet, 28), 1u);  // 3D
  EXPECT_EQ(word_at(packet, 32), 2u);  // markers
  EXPECT_FLOAT_EQ(float_at(packet, 40), 1);
  EXPECT_FLOAT_EQ(float_at(packet, 48), 1000);
  EXPECT_FLOAT_EQ(float_at(packet, 56), 250);
}

TEST(Qtm, WritesNaNForMissing) {
  const std::string packet = QtmScene(5).packet({QtmComponent::points_residual, QtmComponent::bodies});
  EXPECT_FLOAT_EQ(float_at(packet, 52), 0.5F);  // mm
  for (std::size_t at = 56; at < 72; at += 4) EXPECT_TRUE(std::isnan(float_at(packet, at)));
  const std::string lost = QtmScene(7).packet({QtmComponent::bodies});
  for (std::size_t at = 40; at < 88; at += 4) EXPECT_TRUE(std::isnan(float_at(lost, at)));
}

TEST(Qtm, OthersBearTheirTracksNumber) {
  const std::string packet = QtmScene(1).packet({QtmComponent::points_no_labels});
  EXPECT_EQ(word_at(packet, 32), 1u);
  EXPECT_FLOAT_EQ(float_at(packet, 44), 2000);
  EXPECT_EQ(word_at(packet, 52), 3u);
}

TEST(Qtm, ARotationGoesColumnByColumnAndAsDegrees) {
  const std::string packet = QtmScene(50).packet({QtmComponent::bodies, QtmComponent::bodies_euler});
  EXPECT_FLOAT_EQ(float_at(packet, 44), 50);                                        // y, mm
  EXPECT_FLOAT_EQ(float_at(packet, 52), static_cast<float>(std::cos(0.5)));         // R00
  EXPECT_FLOAT_EQ(float_at(packet, 56), static_cast<float>(std::sin(0.5)));         // R10
  EXPECT_FLOAT_EQ(float_at(packet, 64), static_cast<float>(-std::sin(0.5)));        // R01
  EXPECT_NEAR(float_at(packet, 88 + 16 + 20), 0.5 * 180 / 3.14159265358979, 1e-4);  // yaw
}

TEST(Qtm, EulerAnglesMakeTheRotationAgain) {
  for (const Vector<3>& degrees : {Vector<3>(10, 20, 30), Vector<3>(-170, 60, 5), Vector<3>(90, -80, 179)}) {
    const Vector<3> rad = degrees * (3.14159265358979 / 180);
    const Matrix<3> R = geometry::rotation_from({rad.x(), 0, 0}) * geometry::rotation_from({0, rad.y(), 0}) *
                        geometry::rotation_from({0, 0, rad.z()});
    EXPECT_LT((qtm_euler_degrees(R) - degrees).norm(), 1e-9);
  }
}

TEST(Qtm, ASegmentIsInItsParentsFrameUnlessTheWorldsIsAskedFor) {
  const std::string local = QtmScene(1).packet({QtmComponent::skeletons});
  EXPECT_EQ(word_at(local, 32), 1u);  // skeletons
  EXPECT_EQ(word_at(local, 36), 2u);  // segments
  EXPECT_EQ(word_at(local, 72), 3u);  // the second one's id
  EXPECT_NEAR(float_at(local, 76), 100, 1e-3);
  EXPECT_NEAR(float_at(local, 84), -100, 1e-3);
  EXPECT_NEAR(float_at(local, 96), std::sin(0.1), 1e-6);  // z of the quaternion
  const std::string global = QtmScene(1).packet({QtmComponent::skeletons}, true);
  EXPECT_NEAR(float_at(global, 84), 900, 1e-3);
}

TEST(Qtm, CommandsAreAnsweredWordForWord) {
  QtmScene scene;
  QtmSession session(scene.state, {});
  const auto stated = [&](std::string_view command) { return text_of_reply(session.answer(command)); };
  EXPECT_EQ(stated(std::string_view("Version 1.19\0", 13)), "1 Version set to 1.19");
  EXPECT_EQ(stated("version 1.28"), "0 Version NOT supported");
  EXPECT_EQ(stated("version 1.25"), "1 Version set to 1.25");
  EXPECT_EQ(stated("QTMVersion"), "1 QTM Version is 2.17 (build 4000)");
  EXPECT_EQ(stated("ByteOrder"), "1 Byte order is little endian");
  EXPECT_EQ(stated("takecontrol "), "0 Client control disabled in QTM");
  EXPECT_EQ(stated("start"), "0 You must be master to issue this command");
  EXPECT_EQ(stated("StreamFrames AllFrames nonsense"), "0 Parse error");
  EXPECT_EQ(stated("StreamFrames AllFrames UDP:10.0.0.1:99 3D"), "0 UDP goes to the client's own address");
  EXPECT_EQ(stated("GetParameters Analog"), "0 Parameters not available");
  EXPECT_EQ(stated("what"), "0 Parse error");
  EXPECT_EQ(session.answer("GetState").at(0), std::string("\x09\0\0\0\x06\0\0\0\x01", 9));
  EXPECT_EQ(session.answer("GetCurrentFrame 3D").at(0), std::string("\x08\0\0\0\x04\0\0\0", 8));
  EXPECT_EQ(stated("StreamFrames Stop"), "nothing");
}

TEST(Qtm, ControllingClientRecords) {
  QtmScene scene;
  scene.state.allow_control = true;
  std::vector<bool> requested;
  scene.state.record = [&](bool on) { return requested.push_back(on), true; };
  QtmSession first(scene.state, {});
  {
    QtmSession second(scene.state, {});
    EXPECT_EQ(text_of_reply(first.answer("TakeControl secret")), "1 You are now master");
    EXPECT_EQ(text_of_reply(second.answer("TakeControl")), "0 Another client is already master");
    EXPECT_EQ(text_of_reply(first.answer("start")), "1 Starting measurement");
    EXPECT_EQ(text_of_reply(first.answer("stop")), "1 Stopping measurement");
    EXPECT_EQ(text_of_reply(first.answer("releasecontrol")), "1 You are now a regular client");
    EXPECT_EQ(text_of_reply(second.answer("takecontrol")), "1 You are now master");
  }
  EXPECT_EQ(text_of_reply(first.answer("takecontrol")), "1 You are now master");  // who is gone is no master
  EXPECT_EQ(requested, (std::vector{true, false}));
}

TEST(Qtm, ParametersNameLabelsAndBodies) {
  QtmScene scene;
  QtmSession session(scene.state, {});
  session.answer("version 1.19");
  const std::string old = session.answer("GetParameters 3D 6D").at(0);
  EXPECT_NE(old.find("<Labels>2</Labels><Label><Name>LASI</Name>"), std::string::npos);
  EXPECT_NE(old.find("<Bodies>1</Bodies><Body><Name>racket</Name>"), std::string::npos);
  session.answer("version 1.25");
  const std::string all = session.answer("GetParameters All").at(0);
  EXPECT_NE(all.find("<Frequency>100</Frequency>"), std::string::npos);
  EXPECT_NE(all.find(R"(<Point X="100.000000" Y="0.000000" Z="0.000000" Virtual="0" PhysicalId="0" Name="corner"/>)"),
            std::string::npos);
  EXPECT_NE(all.find(R"(<Segment Name="LeftUpLeg" ID="3">)"), std::string::npos);
}

TEST(Qtm, AStreamIsThinnedAsAskedFor) {
  QtmScene scene;
  QtmSession session(scene.state, {});
  const auto given = [&](const char* command) {
    session.answer(command);
    int count = 0;
    for (int k = 0; k < 100; ++k) count += session.is_due(test::moving_bodies(k));
    return count;
  };
  EXPECT_EQ(given("streamframes allframes 3d"), 100);
  EXPECT_EQ(given("streamframes frequencydivisor:4 3d"), 25);
  EXPECT_EQ(given("streamframes frequency:30 3d"), 30);
  EXPECT_EQ(given("streamframes frequency:0 3d"), 0);
  EXPECT_EQ(given("streamframes stop"), 0);
}

TEST(Qtm, PacketsOfNoSizeAndOfGigabytesAreRefused) {
  EXPECT_FALSE(qtm_received("\x08\0\0"));
  EXPECT_FALSE(qtm_received(std::string_view("\x0a\0\0\0\x01\0\0\0x", 9)));
  EXPECT_THROW(qtm_received(std::string_view("\x07\0\0\0\x01\0\0\0", 8)), Error);
  EXPECT_THROW(qtm_received(std::string_view("\xff\xff\xff\xff", 4)), Error);
  const auto packet = qtm_received(std::string_view("\x0a\0\0\0\x01\0\0\0ab", 10));
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->body, "ab");
}

}  // namespace
}  // namespace marey::stream
