#include "marey/format/rig/room_file.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/nesting.h"
#include "marey/format/read_file.h"
#include "marey/format/rig/rig_section.h"

namespace marey::format::rig {
namespace {

constexpr double kMountSpacing = 1.0;  // m along a wall
constexpr std::size_t kMaxMounts = 400;
constexpr int kMaxPlanned = 64;
constexpr double kMaxRoom = 1000;  // m

std::optional<Vector<3>> point_of(const Section& section, const char* key) {
  const auto numbers = section.numbers(key, 3, 3, "three numbers, m: [x, y, z]");
  if (!numbers) return std::nullopt;
  const Vector<3> point((*numbers)[0], (*numbers)[1], (*numbers)[2]);
  if (point.cwiseAbs().maxCoeff() > kMaxRoom) section.problem(key, fmt::format("{} is farther than 1000 m; write metres", key));
  return point;
}

/// `flat`: may be without height.
RoomBox box_of(const Section& section, bool flat = false) {
  const auto from = point_of(section, "from"), to = point_of(section, "to");
  if (!from) section.problem("from", "from is missing; write the box's lowest corner: from = [-2, -2, 0]");
  if (!to) section.problem("to", "to is missing; write the box's highest corner: to = [2, 2, 2]");
  if (!from || !to) return {};
  const Vector<3> extent = *to - *from;
  if (!(extent.x() > 0 && extent.y() > 0 && (extent.z() > 0 || (flat && extent.z() == 0))))
    section.problem("to", "to must be above from in each coordinate");
  return {*from, *to};
}

/// Evenly along the four walls of a box, at its lowest and its highest height.
std::vector<Vector<3>> mounts_on_walls(const RoomBox& box) {
  std::vector<double> heights{box.from.z()};
  if (box.to.z() - box.from.z() > 0.3) heights.push_back(box.to.z());
  const double length = box.to.x() - box.from.x(), width = box.to.y() - box.from.y();
  const double spacing = std::max(kMountSpacing, 4 * (length + width) / static_cast<double>(kMaxMounts));
  const int along = std::max(1, static_cast<int>(std::floor(length / spacing))),
            across = std::max(1, static_cast<int>(std::floor(width / spacing)));
  std::vector<Vector<3>> places;
  for (const double z : heights) {
    for (int i = 0; i <= along; ++i) {
      for (const double y : {box.from.y(), box.to.y()}) places.emplace_back(box.from.x() + length * i / along, y, z);
    }
    for (int i = 1; i < across; ++i) {
      for (const double x : {box.from.x(), box.to.x()}) places.emplace_back(x, box.from.y() + width * i / across, z);
    }
  }
  return places;
}

void read_mounts(const toml::table& table, PlannedRoom& room, Problems& problems) {
  const Section section(table, "mounts", problems);
  section.only({"from", "to", "places"});
  if (section.has("places") && (section.has("from") || section.has("to")))
    section.problem("places", "places and a box both specify where cameras may be; remove one");
  if (!section.has("places")) {
    room.mounts = mounts_on_walls(box_of(section, true));
    return;
  }
  for (const std::vector<double>& row : section.rows("places", 3, kMaxMounts, "places in m: [[x, y, z], …]"))
    room.mounts.emplace_back(row[0], row[1], row[2]);
  if (room.mounts.size() < 2) section.problem("places", "places has fewer than two");
}

void read_cameras(const toml::table& table, PlannedRoom& room, Problems& problems) {
  const Section section(table, "cameras", problems);
  section.only({"count", "size", "field_of_view", "noise_px", "farthest"});
  room.cameras = section.count("count").value_or(room.cameras);
  if (room.cameras < 2 || room.cameras > kMaxPlanned) section.problem("count", fmt::format("count must be 2 to {}", kMaxPlanned));
  if (const auto size = section.numbers("size", 2, 2, "width and height in px: [1920, 1080]")) {
    room.size = {static_cast<int>((*size)[0]), static_cast<int>((*size)[1])};
    if (room.size.width < 16 || room.size.height < 16 || room.size.width > 32768 || room.size.height > 32768)
      section.problem("size", "size must be 16 to 32768 px");
  }
  const double degrees = section.positive("field_of_view").value_or(room.field_of_view * 180 / std::numbers::pi);
  if (degrees < 1 || degrees > 150) section.problem("field_of_view", "field_of_view must be 1 to 150 degrees across the image");
  room.field_of_view = degrees * std::numbers::pi / 180;
  room.noise_px = section.positive("noise_px").value_or(room.noise_px);
  room.farthest_m = section.positive("farthest");
}

const toml::table* table_named(const toml::table& root, const char* key) {
  const toml::node* const node = root.get(key);
  return node == nullptr ? nullptr : node->as_table();
}

void read_obstacles(const toml::table& root, PlannedRoom& room, Problems& problems) {
  const toml::node* const node = root.get("obstacle");
  if (node == nullptr) return;
  const toml::array* const list = node->as_array();
  if (list == nullptr || list->size() > 1000) {
    problems.add(node->source(), "obstacle: is not a list; write [[obstacle]] before each, at most 1000");
    return;
  }
  for (const toml::node& each : *list) {
    if (!each.is_table()) continue;
    const Section section(*each.as_table(), "obstacle", problems);
    section.only({"from", "to"});
    room.obstacles.push_back(box_of(section));
  }
}

}  // namespace

PlannedRoom parse_room(std::string_view text, const std::string& name) {
  check_nesting(text, Notation::toml, name);
  toml::table root;
  try {
    root = toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    throw Error("{}:{}: {}", name, error.source().begin.line, excerpt(error.description(), 200));
  }
  Problems problems(name);
  PlannedRoom room;
  for (const auto& [key, node] : root) {
    if (key != "volume" && key != "mounts" && key != "cameras" && key != "obstacle" && key != "points")
      problems.add(node.source(),
                   fmt::format("\"{}\" is not known; a room has [volume], [mounts], [cameras], [[obstacle]] and points",
                               excerpt(key.str())));
  }
  if (const toml::table* const volume = table_named(root, "volume")) {
    const Section section(*volume, "volume", problems);
    section.only({"from", "to"});
    room.volume = box_of(section);
  } else {
    problems.add(root.source(), "has no [volume]; write the box in which people move: from = [x, y, z], to = [x, y, z]");
  }
  if (const toml::table* const mounts = table_named(root, "mounts")) {
    read_mounts(*mounts, room, problems);
  } else {
    problems.add(root.source(),
                 "has no [mounts]; write the box on whose walls cameras may be (from, to), or places = [[x, y, z], …]");
  }
  if (const toml::table* const cameras = table_named(root, "cameras")) read_cameras(*cameras, room, problems);
  if (const auto points = root["points"].value<std::string>()) {
    room.facing = *points == "bodies";
    if (*points != "bodies" && *points != "free")
      problems.add(root["points"].node()->source(),
                   "points: must be \"bodies\" (markers, which a body hides from behind) or \"free\" (joints of a body, a ball)");
  }
  read_obstacles(root, room, problems);
  problems.throw_if_any();
  return room;
}

PlannedRoom read_room(const std::string& path) {
  return parse_room(read_file(path), path);
}

}  // namespace marey::format::rig
