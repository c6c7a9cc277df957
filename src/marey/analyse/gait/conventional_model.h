// The conventional gait model (Davis, Õunpuu, Tyburski, Gage 1991; Kadaba, Ramakrishnan, Wootten 1990), as Plug-in Gait has it: of
// the markers of one instant, where the joints' centres are and how the segments stand. Hips by regression on leg length and pelvis
// (Davis, equations 1 to 3); knees and ankles where a right angle stands over the marker, half a joint's width away in the plane of
// the marker above or below (the chord function); shoulders, elbows, wrists and hands likewise; feet by the line from ankle to toe,
// corrected by what a static trial says of the sole.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "marey/core/geometry.h"
#include "marey/geometry/rigid.h"

namespace marey::analyse::gait {

enum class Side : std::uint8_t { left, right };
inline constexpr std::array kSides = {Side::left, Side::right};

/// A body's segments, each with x ahead, y to the person's left, z up when it stands straight with its arms down. A limb's origin
/// is its upper joint; the pelvis' is midway between the hips' front spines, the trunk's between the hips' top and neck, the head's
/// in its middle. A clavicle reaches from the breastbone's top to the shoulder, its axes parallel to the trunk's.
enum class SegmentId : std::uint8_t {
  pelvis,
  trunk,
  head,
  left_thigh,
  left_shank,
  left_foot,
  left_upper_arm,
  left_forearm,
  left_hand,
  left_clavicle,
  right_thigh,
  right_shank,
  right_foot,
  right_upper_arm,
  right_forearm,
  right_hand,
  right_clavicle,
};
inline constexpr std::size_t kSegments = 17;
std::string_view name_of(SegmentId segment);
/// "thigh" of a side.
SegmentId of_side(SegmentId left, Side side);

using MarkerPositions = std::map<std::string, Vector<3>, std::less<>>;

/// A person's measures, m, left and right. What is not given is taken from the leg's length, as people mostly are.
struct GaitSubject {
  std::array<std::optional<double>, 2> leg_length, knee_width, ankle_width;
  std::array<std::optional<double>, 2> shoulder_offset, elbow_width, wrist_width, hand_thickness;  ///< offset: centre below skin
  std::optional<double> asis_distance;  ///< between the hips' front spines; else between their markers, instant by instant
  std::array<std::optional<Vector<3>>, 2>
      hip_in_pelvis;  ///< centres in the pelvis' frame, where better is known than the regression
  double marker_radius = 0.007;
  std::array<Matrix<3>, 2> sole_from_ankle_toe = {Matrix<3>::Identity(), Matrix<3>::Identity()};  ///< of a static trial

  /// Fills in what a standing person's markers determine: leg lengths, and how the feet stand.
  void learn_from(const MarkerPositions& standing);
};

/// Segments that the markers of an instant determine.
struct GaitPose {
  std::array<std::optional<Rigid3>, kSegments> world_from;
  const std::optional<Rigid3>& operator[](SegmentId segment) const { return world_from[static_cast<std::size_t>(segment)]; }
  std::optional<Rigid3>& operator[](SegmentId segment) { return world_from[static_cast<std::size_t>(segment)]; }
};
GaitPose pose_of(const MarkerPositions& markers, const GaitSubject& subject);

/// Plug-in Gait's markers, without those that are computed.
std::span<const std::string_view> plug_in_gait_markers();
/// Which segment each sits on; nothing for a marker that is not one of them.
std::optional<SegmentId> segment_of_marker(std::string_view label);

}  // namespace marey::analyse::gait
