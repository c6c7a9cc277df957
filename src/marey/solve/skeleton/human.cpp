#include "marey/solve/skeleton/human.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "marey/core/error.h"

namespace marey::solve::skeleton {
namespace {

struct Turn {
  const char* name;        ///< behind the joint's
  char axis;               ///< of the upper segment, then of what is turned already
  double sign;             ///< of the left side or the middle; about x and z the right side's is the other
  double lowest, highest;  ///< degrees; the same: no limit
};

struct HumanJoint {
  const char* segment;
  const char* parent;
  const char* joint;
  std::array<Turn, 3> rotations;
  int count;
};

/// What hangs on what, and how. Knees are hinges and elbows have no sideways turn: with two markers a segment that is what they
/// show. Shoulders rise and come ahead on the trunk, by 3 cm between standing and walking in one of six children: an arm that hung
/// on the trunk itself would be straightened by that much.
constexpr std::array<HumanJoint, 9> kJoints = {{
    {"trunk", "pelvis", "spine", {{{"flexion", 'y', 1, 0, 0}, {"lateral_bending", 'x', 1, 0, 0}, {"rotation", 'z', -1, 0, 0}}}, 3},
    {"head", "trunk", "neck", {{{"flexion", 'y', 1, 0, 0}, {"lateral_bending", 'x', 1, 0, 0}, {"rotation", 'z', -1, 0, 0}}}, 3},
    {"thigh", "pelvis", "hip", {{{"flexion", 'y', -1, 0, 0}, {"adduction", 'x', -1, 0, 0}, {"rotation", 'z', -1, 0, 0}}}, 3},
    {"shank", "thigh", "knee", {{{"flexion", 'y', 1, -15, 165}, {}, {}}}, 1},
    {"foot", "shank", "ankle", {{{"dorsiflexion", 'y', -1, 0, 0}, {"inversion", 'x', -1, 0, 0}, {"rotation", 'z', -1, 0, 0}}}, 3},
    {"clavicle", "trunk", "shoulder_girdle", {{{"elevation", 'x', 1, -45, 45}, {"protraction", 'z', -1, -45, 45}, {}}}, 2},
    {"upper_arm",
     "clavicle",
     "shoulder",
     {{{"flexion", 'y', -1, 0, 0}, {"adduction", 'x', -1, 0, 0}, {"rotation", 'z', -1, 0, 0}}},
     3},
    {"forearm", "upper_arm", "elbow", {{{"flexion", 'y', -1, -15, 165}, {"pronation", 'z', -1, -180, 180}, {}}}, 2},
    {"hand", "forearm", "wrist", {{{"radial_deviation", 'y', -1, -80, 80}, {"flexion", 'x', -1, -110, 110}, {}}}, 2},
}};

Vector<3> unit_of(char axis) {
  return Vector<3>::Unit(axis - 'x');
}

class HumanBuilder {
 public:
  explicit HumanBuilder(std::span<const StandingSegment> segments) : standing_(segments) {}

  Skeleton build(const std::string& name, std::span<const StandingMarker> markers) {
    skeleton_.name = name;
    add_pelvis();
    for (const HumanJoint& joint : kJoints) {
      const bool middle = std::string_view(joint.segment) == "trunk" || std::string_view(joint.segment) == "head";
      for (const std::string side : {"left_", "right_"}) {
        if (middle) {
          if (side == "left_") add(joint, "", "");
        } else {
          add(joint, side, side);
        }
      }
    }
    for (const StandingMarker& marker : markers) add_marker(marker);
    return std::move(skeleton_);
  }

 private:
  const StandingSegment* standing(const std::string& name) const {
    const auto found = std::find_if(standing_.begin(), standing_.end(), [&](const StandingSegment& s) { return s.name == name; });
    return found == standing_.end() ? nullptr : &*found;
  }

  void add_axis(Joint& joint, bool is_rotation, const Vector<3>& axis, std::string name,
                std::optional<std::pair<double, double>> limits = {}) {
    Coordinate coordinate;
    coordinate.name = std::move(name);
    coordinate.is_rotation = is_rotation;
    if (limits) {
      coordinate.lowest = limits->first;
      coordinate.highest = limits->second;
    }
    joint.axes.push_back({is_rotation, axis, {}, static_cast<int>(skeleton_.coordinates.size())});
    skeleton_.coordinates.push_back(std::move(coordinate));
  }

  void add_pelvis() {
    if (standing("pelvis") == nullptr)
      throw Error("{}: the pelvis is not known; a person's skeleton begins with it", skeleton_.name);
    Segment pelvis{.name = "pelvis", .parent = {}, .joint = {}, .end = {}};
    for (const char axis : {'x', 'y', 'z'}) add_axis(pelvis.joint, false, unit_of(axis), std::string("pelvis_t") + axis);
    add_axis(pelvis.joint, true, Vector<3>::UnitZ(), "pelvis_rotation");
    add_axis(pelvis.joint, true, Vector<3>::UnitY(), "pelvis_tilt");
    add_axis(pelvis.joint, true, Vector<3>::UnitX(), "pelvis_obliquity");
    skeleton_.segments.push_back(std::move(pelvis));
  }

  void add(const HumanJoint& joint, const std::string& side, const std::string& prefix) {
    const bool sided_parent = std::string_view(joint.parent) != "pelvis" && std::string_view(joint.parent) != "trunk";
    const std::string name = side + joint.segment;
    std::string parent_name = (sided_parent ? side : "") + joint.parent;
    if (parent_name.ends_with("clavicle") && standing(parent_name) == nullptr) parent_name = "trunk";
    const StandingSegment* const own = standing(name);
    const StandingSegment* const parent = standing(parent_name);
    const auto on = skeleton_.segment(parent_name);
    if (own == nullptr || parent == nullptr || !on) return;
    Segment segment{.name = name, .parent = on, .joint = {}, .end = {}};
    segment.joint.parent_from_joint.translation = parent->world_from.inverse() * own->world_from.translation;
    for (int i = 0; i < joint.count; ++i) {
      const Turn& turn = joint.rotations[static_cast<std::size_t>(i)];
      const double mirror = side == "right_" && turn.axis != 'y' ? -1 : 1;
      std::optional<std::pair<double, double>> limits;
      if (turn.lowest < turn.highest)
        limits = std::pair(turn.lowest * std::numbers::pi / 180, turn.highest * std::numbers::pi / 180);
      add_axis(segment.joint, true, turn.sign * mirror * unit_of(turn.axis), prefix + joint.joint + "_" + turn.name, limits);
    }
    if (own->end) segment.end = own->world_from.inverse() * *own->end;
    skeleton_.segments.push_back(std::move(segment));
  }

  void add_marker(const StandingMarker& marker) {
    const auto on = skeleton_.segment(marker.segment);
    const StandingSegment* const segment = standing(marker.segment);
    if (!on || segment == nullptr) return;
    skeleton_.markers.push_back({marker.label, *on, segment->world_from.inverse() * marker.location, 1});
  }

  std::span<const StandingSegment> standing_;
  Skeleton skeleton_;
};

}  // namespace

Skeleton human_skeleton(const std::string& name, std::span<const StandingSegment> segments,
                        std::span<const StandingMarker> markers) {
  return HumanBuilder(segments).build(name, markers);
}

}  // namespace marey::solve::skeleton
