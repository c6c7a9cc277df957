#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/skeleton.h"
#include "marey/geometry/rigid.h"
#include "marey/simulate/random.h"

namespace marey::simulate::room {

constexpr int kLimbs = 15;

/// A part of the body: a line from its joint, thickened to `radius` m. Its frame has the origin in the joint.
struct LimbShape {
  std::string_view name;
  Vector<3> end;  ///< m, in the limb's frame; standing upright all frames have x ahead, y to the left, z up
  double radius;  ///< m
};
const std::array<LimbShape, kLimbs>& limb_shapes();

/// Where every limb is: world_from_limb, in m.
using BodyPose = std::array<Rigid3, kLimbs>;

/// A person of 1.75 m, the pelvis over (x, y), that faces along `heading` (rad from the x axis).
struct BodyStance {
  double x = 0, y = 0, heading = 0;
};

/// `phase` in rad, one double step a turn.
BodyPose walking_pose(const BodyStance& stance, double phase);
/// Both arms wave beside the head; `time_s` counts.
BodyPose waving_pose(const BodyStance& stance, double time_s);
/// Upright, the arms spread aside.
BodyPose standing_pose(const BodyStance& stance);

/// A marker on the body: its centre lies a little outside the limb.
struct BodyMarker {
  int limb = 0;
  Vector<3> in_limb = Vector<3>::Zero();  ///< m
  std::string label;                      ///< limb and number: "left_thigh2"
};

/// Spreads markers over the body by the limbs' surfaces, as far from each other as they fit.
std::vector<BodyMarker> place_markers(int count, Random& random);

/// The body as a skeleton, its segments the limbs in their order: at rest upright with the arms down, the pelvis free, hands and
/// feet fixed, everything else balls.
Skeleton body_skeleton(std::span<const BodyMarker> markers);

/// Whether some limb stands between two points.
bool hidden_by_body(const BodyPose& pose, const Vector<3>& from, const Vector<3>& to);

}  // namespace marey::simulate::room
