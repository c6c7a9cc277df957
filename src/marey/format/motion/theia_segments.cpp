#include "marey/format/motion/theia_segments.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "marey/geometry/median.h"

namespace marey::format::motion {
namespace {

constexpr std::size_t kMaxOffsetFrames = 2000;  // numerical: the median of more is the same

struct TheiaSegment {
  std::string_view name, parent;
};
// Names of Theia3D 2020 to 2023; newer files have pelvis_shifted and abdomen too.
constexpr std::array<TheiaSegment, 21> kTheiaSegments = {
    {{"pelvis", ""},           {"abdomen", "pelvis"},    {"torso", "abdomen"},  {"neck", "torso"},      {"head", "neck"},
     {"l_clavicle", "torso"},  {"l_uarm", "l_clavicle"}, {"l_larm", "l_uarm"},  {"l_hand", "l_larm"},   {"r_clavicle", "torso"},
     {"r_uarm", "r_clavicle"}, {"r_larm", "r_uarm"},     {"r_hand", "r_larm"},  {"l_thigh", "pelvis"},  {"l_shank", "l_thigh"},
     {"l_foot", "l_shank"},    {"l_toes", "l_foot"},     {"r_thigh", "pelvis"}, {"r_shank", "r_thigh"}, {"r_foot", "r_shank"},
     {"r_toes", "r_foot"}}};
constexpr std::array<std::string_view, 5> kNeeded = {"pelvis", "l_thigh", "r_thigh", "l_shank", "r_shank"};

std::string_view parent_name(std::string_view name) {
  const auto segment = std::find_if(kTheiaSegments.begin(), kTheiaSegments.end(), [&](const auto& s) { return s.name == name; });
  return segment == kTheiaSegments.end() ? std::string_view() : segment->parent;
}

/// Of the child's origin in the parent's frame, each coordinate by itself; nothing if the two are never there together.
std::optional<Vector<3>> median_offset(std::size_t parent, std::size_t child, std::size_t frames, const PoseInFrame& pose) {
  std::array<std::vector<double>, 3> along;
  const std::size_t step = std::max<std::size_t>(1, frames / kMaxOffsetFrames);
  for (std::size_t frame = 0; frame < frames; frame += step) {
    const auto above = pose(frame, parent), below = pose(frame, child);
    if (!above || !below) continue;
    const Vector<3> offset = above->inverse() * below->translation;
    for (std::size_t axis = 0; axis < 3; ++axis) along[axis].push_back(offset[static_cast<Eigen::Index>(axis)]);
  }
  if (along[0].empty()) return std::nullopt;
  return Vector<3>(geometry::median(along[0]), geometry::median(along[1]), geometry::median(along[2]));
}

/// In the order that they have, but each behind its parent.
void parents_first(std::vector<Body>& bodies) {
  std::vector<Body> ordered;
  std::vector<bool> placed(bodies.size(), false);
  const auto is_placed = [&](BodyId id) {
    return std::any_of(ordered.begin(), ordered.end(), [&](const Body& b) { return b.id == id; });
  };
  while (ordered.size() < bodies.size()) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (placed[i] || (bodies[i].parent && !is_placed(*bodies[i].parent))) continue;
      placed[i] = true;
      ordered.push_back(bodies[i]);
    }
  }
  bodies = std::move(ordered);
}

}  // namespace

bool hang_theia_segments(std::vector<Body>& bodies, std::size_t frames, const PoseInFrame& pose) {
  std::map<std::string, std::size_t, std::less<>> index;
  for (std::size_t i = 0; i < bodies.size(); ++i) index.emplace(bodies[i].label, i);
  if (!std::all_of(kNeeded.begin(), kNeeded.end(), [&](std::string_view name) { return index.contains(name); })) return false;
  std::vector<bool> hung(bodies.size(), false);
  for (const TheiaSegment& segment : kTheiaSegments) {  // parents before children
    const auto found = index.find(segment.name);
    if (found == index.end()) continue;
    Body& body = bodies[found->second];
    std::string_view above = segment.parent;
    while (!above.empty() && !index.contains(above)) above = parent_name(above);  // a torso without an abdomen hangs on the pelvis
    if (!above.empty()) {
      const std::size_t parent = index.find(above)->second;
      const auto offset = hung[parent] ? median_offset(parent, found->second, frames, pose) : std::nullopt;
      if (!offset) continue;
      body.parent = bodies[parent].id;
      body.offset = *offset;
    }
    body.skeleton = "theia";
    hung[found->second] = true;
  }
  parents_first(bodies);
  return true;
}

}  // namespace marey::format::motion
