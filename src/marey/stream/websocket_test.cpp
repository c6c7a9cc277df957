#include "marey/stream/websocket.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/stream/foxglove_requests.h"

namespace marey::stream {
namespace {

TEST(WebSocket, TheKeyIsAnsweredAsTheStandardsExampleHasIt) {
  EXPECT_EQ(accept_key("dGhlIHNhbXBsZSBub25jZQ=="), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo\xff"), "Zm9v/w==");
}

TEST(WebSocket, ForeignPagesAndForeignNamesAreRefused) {
  for (const char* origin : {"", "http://localhost:8080", "http://127.0.0.1", "https://app.foxglove.dev", "file:///a"})
    EXPECT_TRUE(is_trusted_origin(origin)) << origin;
  for (const char* origin : {"https://evil.example", "http://localhost.evil.example", "null",
                             "https://app.foxglove.dev.evil.example", "http://127.0.0.1.evil.example"})
    EXPECT_FALSE(is_trusted_origin(origin)) << origin;
  for (const char* host : {"localhost:8765", "127.0.0.1:8765", "192.168.0.9", "[::1]:80"}) EXPECT_TRUE(is_plain_host(host)) << host;
  for (const char* host : {"evil.example:8765", "localhost.evil.example", ""}) EXPECT_FALSE(is_plain_host(host)) << host;
}

TEST(WebSocket, ARequestIsReadWithoutRegardToCase) {
  const Upgrade upgrade = parse_upgrade(
      "GET / HTTP/1.1\r\nHOST: localhost:1\r\nupgrade: WebSocket\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: a, foxglove.sdk.v1\r\nOrigin: http://x");
  EXPECT_EQ(upgrade.host, "localhost:1");
  EXPECT_EQ(upgrade.origin, "http://x");
  EXPECT_EQ(upgrade.protocols, (std::vector<std::string>{"a", "foxglove.sdk.v1"}));
  EXPECT_THROW(parse_upgrade("GET / HTTP/1.1\r\nHost: a"), Error);
  EXPECT_THROW(parse_upgrade("POST / HTTP/1.1"), Error);
}

TEST(WebSocket, FramesOfEverySizeHaveTheirHead) {
  EXPECT_EQ(frame_head(Opcode::text, 5), "\x81\x05");
  EXPECT_EQ(frame_head(Opcode::binary, 300), std::string("\x82\x7e\x01\x2c", 4));
  EXPECT_EQ(frame_head(Opcode::binary, 65'536), std::string("\x82\x7f\0\0\0\0\0\x01\0\0", 10));
}

TEST(WebSocket, AClientsFrameIsUnmaskedOrRefused) {
  ClientFrame frame;
  const std::string hello("\x81\x85\x37\xfa\x21\x3d\x7f\x9f\x4d\x51\x58", 11);  // RFC 6455, 5.7
  EXPECT_EQ(parse_frame(hello, 100, frame), 11u);
  EXPECT_EQ(frame.payload, "Hello");
  for (std::size_t size = 0; size < hello.size(); ++size) EXPECT_EQ(parse_frame(hello.substr(0, size), 100, frame), 0u);
  EXPECT_THROW(parse_frame(std::string("\x81\x05Hello"), 100, frame), Error);                                 // no mask
  EXPECT_THROW(parse_frame(std::string("\xc1\x85", 2), 100, frame), Error);                                   // an extension's bit
  EXPECT_THROW(parse_frame(std::string("\x83\x85", 2), 100, frame), Error);                                   // no such kind
  EXPECT_THROW(parse_frame(std::string("\x81\xff\xff\xff\xff\xff\xff\xff\xff\xff", 10), 100, frame), Error);  // 2^64 bytes
  EXPECT_THROW(parse_frame(std::string("\x09\x80\0\0\0\0", 6), 100, frame), Error);                           // a ping in pieces
}

TEST(Foxglove, RequestsAreReadOrRefused) {
  const auto request = foxglove_request(R"({"op":"subscribe","subscriptions":[{"id":5,"channelId":1}]})");
  ASSERT_TRUE(request);
  ASSERT_EQ(request->subscribe.size(), 1u);
  EXPECT_EQ(request->subscribe[0].id, 5u);
  EXPECT_EQ(request->subscribe[0].channel, 1u);
  EXPECT_EQ(foxglove_request(R"({"op":"unsubscribe","subscriptionIds":[5,"x",-1]})")->unsubscribe, std::vector<std::uint32_t>{5});
  EXPECT_FALSE(foxglove_request(R"({"op":"getParameters"})"));
  for (const char* wrong :
       {"", "[]", "{", R"({"op":1})", R"({"op":"subscribe"})", R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})"})
    EXPECT_THROW(foxglove_request(wrong), Error) << wrong;
  EXPECT_THROW(foxglove_request(std::string(1000, '[')), Error);
}

TEST(Foxglove, DataBearsItsSubscription) {
  EXPECT_EQ(foxglove_data_head(2, 3), std::string("\x01\x02\0\0\0\x03\0\0\0\0\0\0\0", 13));
  EXPECT_NE(foxglove_advertisement().find("foxglove.PointCloud"), std::string::npos);
}

}  // namespace
}  // namespace marey::stream
