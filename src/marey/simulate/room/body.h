#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/skeleton.h"
#include "marey/simulate/random.h"
#include "marey/simulate/room/body_pose.h"

namespace marey::simulate::room {

/// A part of the body: a line from its joint, thickened to `radius` m. Its frame has the origin in the joint.
struct LimbShape {
  std::string_view name;
  Vector<3> end;  ///< m, in the limb's frame; standing upright all frames have x ahead, y to the left, z up
  double radius;  ///< m
};
const std::array<LimbShape, kLimbs>& limb_shapes();

/// A marker on the body: its centre lies a little outside the limb.
struct BodyMarker {
  int limb = 0;
  Vector<3> in_limb = Vector<3>::Zero();  ///< m
  std::string label;                      ///< limb and number: "left_thigh2"
};

/// Spreads markers over the body by the limbs' surfaces, as far from each other as they fit.
std::vector<BodyMarker> position_markers(int count, Random& random);

/// The body as a skeleton, its segments the limbs in their order: at rest upright with the arms down, the pelvis free, hands and
/// feet fixed, everything else balls.
Skeleton body_skeleton(std::span<const BodyMarker> markers);

/// What the skeleton's coordinates are in a pose: m of the pelvis, rad of each joint.
std::vector<double> body_coordinates(const BodyPose& pose);

/// Where a marker is, m, with the skin that it is on: a thigh's slides by `skin_m` at a bend of 90° or more (other limbs' less),
/// towards the joint that the limb hangs on and a little round the limb.
Vector<3> on_skin(const BodyPose& pose, const BodyMarker& marker, double skin_m);

/// Whether some limb stands between two points.
bool hidden_by_body(const BodyPose& pose, const Vector<3>& from, const Vector<3>& to);

}  // namespace marey::simulate::room
