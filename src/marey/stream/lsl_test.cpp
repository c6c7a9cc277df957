#include <cmath>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/stream/bytes.h"
#include "marey/stream/lsl_messages.h"

#include "support/moving_bodies.h"

namespace marey::stream {
namespace {

LslOutlet outlet_of_bodies() {
  return {.name = "Marey",
          .uid = "uid-1",
          .source_id = "marey <take>",
          .host = "host",
          .rate_hz = 100,
          .created_at = 1.5,
          .port = 16572,
          .layout = {.labels = {"LASI", "RASI"}, .bodies = {test::header_of_moving_bodies().bodies[0]}}};
}

TEST(Lsl, AnOutletIsFoundByWhatItIs) {
  const std::string info = lsl_info_xml(outlet_of_bodies(), false);
  EXPECT_TRUE(lsl_matches(info, "session_id='default' and type='MoCap'"));
  EXPECT_TRUE(lsl_matches(info, "starts-with(name,'Mar') and channel_count=13"));
  EXPECT_TRUE(lsl_matches(info, ""));
  EXPECT_TRUE(lsl_matches(info, "source_id='marey <take>'"));
  EXPECT_FALSE(lsl_matches(info, "type='EEG'"));
  EXPECT_FALSE(lsl_matches(info, "type='"));
  EXPECT_FALSE(lsl_matches(info, std::string(500, '(')));
  EXPECT_FALSE(lsl_matches(info, std::string(5000, '1')));
}

TEST(Lsl, ADescriptionHasAChannelForEachCoordinate) {
  const std::string info = lsl_info_xml(outlet_of_bodies(), true);
  std::size_t count = 0;
  for (std::size_t at = info.find("<channel>"); at != std::string::npos; at = info.find("<channel>", at + 1)) ++count;
  EXPECT_EQ(count, 13u);
  EXPECT_NE(info.find("<label>RASI_Z</label><marker>RASI</marker><type>PositionZ</type><unit>meters</unit>"), std::string::npos);
  EXPECT_NE(info.find("<object>racket</object><type>OrientationA</type>"), std::string::npos);
}

TEST(Lsl, SearchesAndClockQuestionsAreUnderstood) {
  const auto search = lsl_search("LSL:shortinfo\r\ntype='MoCap'\r\n16600 abc123\r\n");
  ASSERT_TRUE(search);
  EXPECT_EQ(search->query, "type='MoCap'");
  EXPECT_EQ(search->port, 16600);
  EXPECT_EQ(search->id, "abc123");
  EXPECT_FALSE(lsl_search("LSL:shortinfo\r\nx\r\n70000 a\r\n"));
  EXPECT_FALSE(lsl_search("LSL:shortinfo\r\nx\r\n0 a\r\n"));
  EXPECT_FALSE(lsl_search("LSL:shortinfo"));
  EXPECT_EQ(lsl_time_answer("LSL:timedata\r\n7 1.5\r\n", 2, 3), " 7 1.5 2 3");
  EXPECT_FALSE(lsl_time_answer("LSL:timedata\r\nx 1.5\r\n", 2, 3));
}

TEST(Lsl, RequestsAreTakenWhenTheyAreWhole) {
  EXPECT_FALSE(lsl_request("LSL:streamfeed/110 uid-1\r\nMax-Buffer-Length: 360\r\n"));
  const std::string feed = "LSL:streamfeed/110 uid-1\r\nMax-Buffer-Length: 360\r\n\r\n";
  EXPECT_EQ(lsl_request(feed)->kind, LslRequest::Kind::feed);
  EXPECT_EQ(lsl_request(feed)->text, "uid-1");
  EXPECT_EQ(lsl_request(feed)->size, feed.size());
  EXPECT_EQ(lsl_request("LSL:fullinfo\r\nrest")->size, 14u);
  EXPECT_THROW(lsl_request("GET / HTTP/1.1\r\n"), Error);
  EXPECT_THROW(lsl_request(std::string(10'000, 'x')), Error);
}

TEST(Lsl, AFeedBeginsWithTwoTestSamples) {
  LslOutlet outlet = outlet_of_bodies();
  outlet.layout = {.labels = {"A"}, .bodies = {}};
  const std::string head = lsl_feed_head(outlet);
  EXPECT_TRUE(head.starts_with("LSL/110 200 OK\r\nUID: uid-1\r\n"));
  const std::string samples = head.substr(head.find("\r\n\r\n") + 4);
  ASSERT_EQ(samples.size(), 2u * (1 + 8 + 12));
  EXPECT_EQ(*number_at<double>(samples, 1), 123456.789);
  EXPECT_EQ(*number_at<float>(samples, 9), 4);
  EXPECT_EQ(*number_at<float>(samples, 13), -5);
  EXPECT_EQ(*number_at<float>(samples, 21 + 9), 2);
  EXPECT_EQ(*number_at<float>(samples, 21 + 13), -3);
}

TEST(Lsl, ChannelsAreNaNWhereNothingIs) {
  ChannelLayout channel_layout;
  channel_layout.begin(test::header_of_moving_bodies());
  channel_layout.add(test::moving_bodies(0).named);
  const Instant instant = test::moving_bodies(5);
  ChannelLayout::Scene scene;
  channel_layout.location(instant, scene);
  const auto channels = lsl_channels(outlet_of_bodies().layout, channel_layout, scene, instant);
  ASSERT_EQ(channels.size(), 13u);
  EXPECT_FLOAT_EQ(channels[0], 0.005F);
  EXPECT_TRUE(std::isnan(channels[3]));
  EXPECT_FLOAT_EQ(channels[8], 1.5F);
  EXPECT_FLOAT_EQ(channels[9], static_cast<float>(std::cos(0.025)));  // the real part first
}

TEST(Lsl, SendsUnlabelledTracksInSlots) {
  const LslLayout layout{.labels = {}, .bodies = {}, .slots = 2};
  ASSERT_EQ(layout.channels(), 8u);
  LslOutlet outlet = outlet_of_bodies();
  outlet.layout = layout;
  const std::string info = lsl_info_xml(outlet, true);
  EXPECT_NE(info.find("<channel_count>8</channel_count>"), std::string::npos);
  EXPECT_NE(info.find("<label>slot2_ID</label><marker>slot2</marker><type>TrackID</type>"), std::string::npos);
  Sample sample;
  sample.track = TrackId{41};
  sample.position = {1, 2, 3};
  const std::vector<const Sample*> slotted{nullptr, &sample};
  const auto channels = lsl_channels(layout, ChannelLayout(), {}, Instant(), slotted);
  ASSERT_EQ(channels.size(), 8u);
  EXPECT_TRUE(std::isnan(channels[0]) && std::isnan(channels[3]));
  EXPECT_EQ(channels[4], 41);
  EXPECT_EQ(channels[7], 3);
}

}  // namespace
}  // namespace marey::stream
