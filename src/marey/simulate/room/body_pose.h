// How a person moves in the room: where each limb is, as a function of time.
#pragma once

#include <array>

#include "marey/core/geometry.h"

namespace marey::simulate::room {

constexpr int kLimbs = 15;

enum Limb {
  pelvis,
  chest,
  head,
  arm_l,
  forearm_l,
  hand_l,
  arm_r,
  forearm_r,
  hand_r,
  thigh_l,
  shank_l,
  foot_l,
  thigh_r,
  shank_r,
  foot_r
};

/// Where every limb is: world_from_limb, in m.
using BodyPose = std::array<Rigid3, kLimbs>;

/// A person of 1.75 m, the pelvis over (x, y), that faces along `heading` (rad from the x axis).
struct BodyStance {
  double x = 0, y = 0, heading = 0;
};

/// `phase` in rad, one double step a turn.
BodyPose walking_pose(const BodyStance& stance, double phase);
BodyPose running_pose(const BodyStance& stance, double phase);
/// Both arms wave beside the head; `time_s` counts.
BodyPose waving_pose(const BodyStance& stance, double time_s);
/// Goes down on both knees and up again, once in 5.2 s.
BodyPose kneeling_pose(const BodyStance& stance, double time_s);
/// Lies on the floor along the heading and rolls to and fro, a whole turn to either side.
BodyPose rolling_pose(const BodyStance& stance, double time_s);
/// Upright, the arms spread aside.
BodyPose standing_pose(const BodyStance& stance);
/// Upright, the arms down: the skeleton's rest.
BodyPose upright_pose(const BodyStance& stance);

}  // namespace marey::simulate::room
