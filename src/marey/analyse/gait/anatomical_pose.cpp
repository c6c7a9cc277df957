#include "marey/analyse/gait/anatomical_pose.h"

#include <optional>
#include <string>

#include "marey/analyse/gait/segment_axes.h"

namespace marey::analyse::gait {
namespace {

constexpr std::array<std::string_view, 16> kLandmarks = {
    "asis", "psis", "hip_centre", "knee_lateral",   "knee_medial",   "ankle_lateral", "ankle_medial",  "heel",
    "toe",  "meta", "shoulder",   "shoulder_joint", "elbow_lateral", "elbow_medial",  "wrist_lateral", "wrist_medial"};

/// Positions by name; what is not there, and what follows from it, is nothing.
class Landmarks {
 public:
  explicit Landmarks(const MarkerPositions& positions) : positions_(positions) {}

  std::optional<Vector<3>> at(Side side, std::string_view name) const {
    const auto found = positions_.find(std::string(side == Side::left ? "left_" : "right_").append(name));
    return found == positions_.end() ? std::nullopt : std::optional(found->second);
  }
  std::optional<Vector<3>> between(Side side, std::string_view a, std::string_view b) const {
    return mean(at(side, a), at(side, b));
  }
  std::optional<Vector<3>> between_sides(std::string_view name) const { return mean(at(Side::left, name), at(Side::right, name)); }
  /// From the right one to the left one.
  std::optional<Vector<3>> to_left(std::string_view name) const { return difference(at(Side::left, name), at(Side::right, name)); }
  /// The direction to the person's left through a joint's outer and inner landmark.
  std::optional<Vector<3>> to_left(Side side, std::string_view outer, std::string_view inner) const {
    const auto outwards = difference(at(side, outer), at(side, inner));
    return outwards && side == Side::right ? std::optional<Vector<3>>(-*outwards) : outwards;
  }

  static std::optional<Vector<3>> difference(const std::optional<Vector<3>>& to, const std::optional<Vector<3>>& from) {
    return to && from ? std::optional<Vector<3>>(*to - *from) : std::nullopt;
  }

 private:
  static std::optional<Vector<3>> mean(const std::optional<Vector<3>>& a, const std::optional<Vector<3>>& b) {
    return a && b ? std::optional<Vector<3>>(0.5 * (*a + *b)) : std::nullopt;
  }

  const MarkerPositions& positions_;
};

void put(std::optional<Rigid3>& segment, const std::optional<Vector<3>>& origin, int first_axis,
         const std::optional<Vector<3>>& first, int second_axis, const std::optional<Vector<3>>& second) {
  if (!origin || !first || !second) return;
  if (const auto axes = axes_from(first_axis, *first, second_axis, *second)) segment = Rigid3{*axes, *origin};
}

void put_trunk(const Landmarks& marks, GaitPose& pose) {
  const auto front = marks.between_sides("asis");
  put(pose[SegmentId::pelvis], front, 1, marks.to_left("asis"), 0, Landmarks::difference(front, marks.between_sides("psis")));
  const auto shoulders = marks.between_sides("shoulder");
  put(pose[SegmentId::trunk], shoulders, 2, Landmarks::difference(shoulders, marks.between_sides("hip_centre")), 1,
      marks.to_left("shoulder"));
}

void put_leg(const Landmarks& marks, Side side, GaitPose& pose) {
  const auto hip = marks.at(side, "hip_centre"), knee = marks.between(side, "knee_lateral", "knee_medial"),
             ankle = marks.between(side, "ankle_lateral", "ankle_medial"), heel = marks.at(side, "heel");
  put(pose[of_side(SegmentId::left_thigh, side)], hip, 2, Landmarks::difference(hip, knee), 1,
      marks.to_left(side, "knee_lateral", "knee_medial"));
  auto& shank = pose[of_side(SegmentId::left_shank, side)];
  put(shank, knee, 2, Landmarks::difference(knee, ankle), 1, marks.to_left(side, "ankle_lateral", "ankle_medial"));
  if (!shank) return;
  put(pose[of_side(SegmentId::left_foot, side)], ankle, 0, Landmarks::difference(marks.between(side, "toe", "meta"), heel), 1,
      Vector<3>(shank->rotation.col(1)));
}

void put_arm(const Landmarks& marks, Side side, GaitPose& pose) {
  const auto shoulder = marks.at(side, "shoulder_joint"), elbow = marks.between(side, "elbow_lateral", "elbow_medial"),
             wrist = marks.between(side, "wrist_lateral", "wrist_medial");
  put(pose[of_side(SegmentId::left_upper_arm, side)], shoulder, 2, Landmarks::difference(shoulder, elbow), 1,
      marks.to_left(side, "elbow_lateral", "elbow_medial"));
  // Ahead is where the thumb is: pronation is 0 with the thumb ahead.
  put(pose[of_side(SegmentId::left_forearm, side)], elbow, 2, Landmarks::difference(elbow, wrist), 0,
      Landmarks::difference(marks.at(side, "wrist_lateral"), marks.at(side, "wrist_medial")));
}

}  // namespace

std::span<const std::string_view> anatomical_landmarks() {
  return kLandmarks;
}

GaitPose anatomical_pose(const MarkerPositions& landmarks) {
  const Landmarks marks(landmarks);
  GaitPose pose;
  put_trunk(marks, pose);
  for (const Side side : kSides) {
    put_leg(marks, side, pose);
    put_arm(marks, side, pose);
  }
  return pose;
}

}  // namespace marey::analyse::gait
