#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/stream/foxglove_requests.h"
#include "marey/stream/web_access.h"

namespace marey::stream {
namespace {

TEST(WebAccess, RefusesForeignPagesAndForeignNames) {
  for (const char* origin : {"", "http://localhost:8080", "http://127.0.0.1", "https://app.foxglove.dev", "file:///a"})
    EXPECT_TRUE(is_trusted_origin(origin)) << origin;
  for (const char* origin : {"https://evil.example", "http://localhost.evil.example", "null",
                             "https://app.foxglove.dev.evil.example", "http://127.0.0.1.evil.example"})
    EXPECT_FALSE(is_trusted_origin(origin)) << origin;
  for (const char* host : {"localhost:8765", "127.0.0.1:8765", "192.168.0.9", "[::1]:80", "LOCALHOST"})
    EXPECT_TRUE(is_plain_host(host)) << host;
  for (const char* host : {"evil.example:8765", "localhost.evil.example", ""}) EXPECT_FALSE(is_plain_host(host)) << host;
}

TEST(WebAccess, ChoosesASubProtocolThatTheClientSpeaks) {
  net::HttpRequest request{.host = "localhost:1", .protocols = {"a", "foxglove.websocket.v1"}, .upgrade = true};
  const auto answer = answer_to_upgrade(request, {"foxglove.sdk.v1", "foxglove.websocket.v1"});
  EXPECT_TRUE(answer.upgrade);
  EXPECT_EQ(answer.protocol, "foxglove.websocket.v1");
  EXPECT_TRUE(answer_to_upgrade(request).upgrade);
  EXPECT_EQ(answer_to_upgrade(request, {"b"}).status, 400);
  request.origin = "https://evil.example";
  EXPECT_EQ(answer_to_upgrade(request).status, 403);
  request = {.host = "localhost"};
  EXPECT_EQ(answer_to_upgrade(request).status, 400);
}

TEST(Foxglove, Base64HasItsPadding) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo\xff"), "Zm9v/w==");
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
