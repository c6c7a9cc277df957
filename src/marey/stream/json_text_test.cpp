#include "marey/stream/json_text.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace marey::stream {
namespace {

TEST(JsonText, ABodyHasItsOtherPoseWhereItIsInQuestion) {
  RecordingHeader header;
  for (const int id : {1, 2})
    header.bodies.push_back({.id = BodyId{id},
                             .label = "body \"" + std::to_string(id) + "\"",
                             .skeleton = {},
                             .parent = {},
                             .offset = {},
                             .end = {},
                             .markers = {}});
  ChannelLayout layout;
  layout.begin(header);
  Instant instant;
  instant.index = 7;
  for (const int id : {1, 2}) {
    BodyPose& pose = instant.bodies.emplace_back();
    pose.body = BodyId{id};
    pose.world_from_body.translation = {1, 2, 3};
    if (id == 2) pose.other = {{geometry::rotation_from({0, 0, 3.14159265}), {-1, 2, 3}}, 0.25};
  }
  const auto json = nlohmann::json::parse(json_frame(header, layout, instant, {}));
  ASSERT_EQ(json["bodies"].size(), 2U);
  EXPECT_EQ(json["bodies"][0]["label"], "body \"1\"");
  EXPECT_FALSE(json["bodies"][0].contains("other"));
  const auto& other = json["bodies"][1]["other"];
  EXPECT_EQ(other["position"], nlohmann::json({-1, 2, 3}));
  EXPECT_NEAR(std::abs(other["rotation"][2].get<double>()), 1, 1e-6);
  EXPECT_EQ(other["probability"], 0.25);
}

}  // namespace
}  // namespace marey::stream
