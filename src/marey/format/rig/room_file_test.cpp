#include "marey/format/rig/room_file.h"

#include <string>

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::format::rig {
namespace {

constexpr const char* kRoom = R"(
points = "free"
[volume]
from = [-2, -1.5, 0]
to = [2, 1.5, 2]
[mounts]
from = [-3, -2.5, 1.2]
to = [3, 2.5, 2.6]
[cameras]
count = 6
size = [1280, 720]
field_of_view = 90
noise_px = 0.3
farthest = 9
[[obstacle]]
from = [0, 0, 0]
to = [0.5, 0.5, 1]
)";

std::string message_of(const std::string& text) {
  try {
    parse_room(text, "room.toml");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(RoomFile, IsRead) {
  const PlannedRoom room = parse_room(kRoom, "room.toml");
  EXPECT_EQ(room.volume.to, Vector<3>(2, 1.5, 2));
  EXPECT_EQ(room.cameras, 6);
  EXPECT_EQ(room.size, cv::Size(1280, 720));
  EXPECT_NEAR(room.field_of_view, 1.5707963, 1e-6);
  EXPECT_EQ(room.noise_px, 0.3);
  EXPECT_EQ(room.farthest_m, 9);
  EXPECT_FALSE(room.facing);
  ASSERT_EQ(room.obstacles.size(), 1U);
  EXPECT_EQ(room.mounts.size(), 2 * (2 * 7 + 2 * 4)) << "each metre of the walls, low and high";
  for (const Vector<3>& mount : room.mounts) {
    EXPECT_TRUE(std::abs(mount.x()) == 3 || std::abs(mount.y()) == 2.5);
    EXPECT_TRUE(mount.z() == 1.2 || mount.z() == 2.6);
  }
}

TEST(RoomFile, EveryProblemIsNamedWithItsLine) {
  const std::string message = message_of(
      "points = \"people\"\nfloor = 1\n[volume]\nfrom = [0, 0, 0]\nto = [1, 1, -1]\n[mounts]\nplaces = [[1, 2, 3]]\n[cameras]\n"
      "count = 1\nfield_of_view = 200\n");
  for (const char* part : {"room.toml:1: points", "room.toml:2: \"floor\" is not known", "to must be above from",
                           "places has fewer than two", "count must be 2 to 64", "field_of_view must be 1 to 150"})
    EXPECT_NE(message.find(part), std::string::npos) << part << " in " << message;
  EXPECT_NE(message_of("[cameras]\n").find("has no [volume]"), std::string::npos);
  EXPECT_NE(message_of("[volume\n").find("room.toml:"), std::string::npos);
  EXPECT_NE(
      message_of("[volume]\nfrom = [0, 0]\nto = [\"a\", 1, nan]\n[mounts]\nfrom = [0,0,0]\nto = [1,1,1]\n").find("three numbers"),
      std::string::npos);
}

}  // namespace
}  // namespace marey::format::rig
