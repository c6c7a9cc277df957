// A body's motions by sines as a person's joints nearly are: hip and knee of a walker after Winter, "Biomechanics and Motor Control
// of Human Movement", reduced to their first harmonics; the others by eye.
#include "marey/simulate/room/body_pose.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "marey/simulate/room/body.h"

namespace marey::simulate::room {
namespace {

constexpr double kHipHeight = 0.93, kHipAside = 0.09, kShoulderUp = 0.40, kShoulderAside = 0.19;

Matrix<3> turn_left(double angle) {  // about z
  return geometry::rotation_from({0, 0, angle});
}
Matrix<3> swing_ahead(double angle) {  // what hangs down moves ahead
  return geometry::rotation_from({0, -angle, 0});
}
Matrix<3> lift_left(double angle) {  // what hangs down moves to the left
  return geometry::rotation_from({angle, 0, 0});
}

struct Joints {
  double bob = 0;                          // m that the pelvis is above its height
  Matrix<3> tilt = Matrix<3>::Identity();  // of the pelvis, against upright and ahead
  double lean = 0, yaw = 0;                // of the chest against the pelvis
  double hip[2] = {0, 0};                  // ahead; [0] is left
  double knee[2] = {0, 0};                 // bent
  double swing[2] = {0, 0};                // shoulder, ahead
  double aside[2] = {0, 0};                // shoulder, away from the body
  double elbow[2] = {0, 0};                // bent ahead
  double wave[2] = {0, 0};                 // forearm, away from the body
};

const Vector<3>& end_of(int limb) {
  return limb_shapes()[static_cast<std::size_t>(limb)].end;
}

void position_arm(BodyPose& pose, const Joints& joints, int side) {
  const int arm = side == 0 ? arm_l : arm_r;
  const double left = side == 0 ? 1 : -1;
  const Rigid3& trunk = pose[chest];
  Rigid3& upper = pose[static_cast<std::size_t>(arm)];
  upper.translation = trunk * Vector<3>(0, left * kShoulderAside, kShoulderUp);
  upper.rotation = trunk.rotation * lift_left(left * joints.aside[side]) * swing_ahead(joints.swing[side]);
  Rigid3& fore = pose[static_cast<std::size_t>(arm) + 1];
  fore.translation = upper * end_of(arm);
  fore.rotation = upper.rotation * lift_left(left * joints.wave[side]) * swing_ahead(joints.elbow[side]);
  Rigid3& hand = pose[static_cast<std::size_t>(arm) + 2];
  hand.translation = fore * end_of(arm + 1);
  hand.rotation = fore.rotation;
}

void position_leg(BodyPose& pose, const Joints& joints, int side) {
  const int thigh = side == 0 ? thigh_l : thigh_r;
  const Rigid3& hips = pose[pelvis];
  Rigid3& upper = pose[static_cast<std::size_t>(thigh)];
  upper.translation = hips * Vector<3>(0, side == 0 ? kHipAside : -kHipAside, 0);
  upper.rotation = hips.rotation * swing_ahead(joints.hip[side]);
  Rigid3& shank = pose[static_cast<std::size_t>(thigh) + 1];
  shank.translation = upper * end_of(thigh);
  shank.rotation = upper.rotation * swing_ahead(-joints.knee[side]);
  Rigid3& foot = pose[static_cast<std::size_t>(thigh) + 2];
  foot.translation = shank * end_of(thigh + 1);
  foot.rotation = shank.rotation;
}

BodyPose pose_of(const BodyStance& stance, const Joints& joints) {
  BodyPose pose;
  pose[pelvis].translation = {stance.x, stance.y, kHipHeight + joints.bob};
  pose[pelvis].rotation = turn_left(stance.heading) * joints.tilt;
  pose[chest].translation = pose[pelvis] * Vector<3>(0, 0, 0.12);
  pose[chest].rotation = pose[pelvis].rotation * turn_left(joints.yaw) * swing_ahead(-joints.lean);
  pose[head].translation = pose[chest] * Vector<3>(0.02, 0, 0.55);
  pose[head].rotation = pose[pelvis].rotation;
  for (const int side : {0, 1}) {
    position_arm(pose, joints, side);
    position_leg(pose, joints, side);
  }
  return pose;
}

}  // namespace

BodyPose walking_pose(const BodyStance& stance, double phase) {
  Joints joints;
  joints.bob = 0.02 * std::cos(2 * phase);
  joints.lean = 0.06;
  joints.yaw = 0.10 * std::sin(phase);
  for (const int side : {0, 1}) {
    const double own = phase + (side == 0 ? 0 : std::numbers::pi);
    joints.hip[side] = 0.10 + 0.42 * std::sin(own);
    joints.knee[side] = 0.12 + 0.45 * (1 + std::cos(own)) / 2;  // most where the leg swings forward
    joints.swing[side] = -0.40 * std::sin(own);
    joints.aside[side] = 0.12;
    joints.elbow[side] = 0.35 - 0.15 * std::sin(own);
  }
  return pose_of(stance, joints);
}

BodyPose waving_pose(const BodyStance& stance, double time_s) {
  Joints joints;
  joints.yaw = 0.15 * std::sin(1.1 * time_s);
  for (const int side : {0, 1}) {
    const double own = 5.2 * time_s + 1.3 * side;
    joints.hip[side] = 0.01;
    joints.knee[side] = 0.02;
    joints.swing[side] = 0.2 * std::sin(0.7 * own);
    joints.aside[side] = 1.5 + 0.25 * std::sin(0.5 * own);
    joints.elbow[side] = 0.15;
    joints.wave[side] = 1.2 + 0.5 * std::sin(own);
  }
  return pose_of(stance, joints);
}

BodyPose standing_pose(const BodyStance& stance) {
  Joints joints;
  for (const int side : {0, 1}) {
    joints.aside[side] = 1.2;
    joints.elbow[side] = 0.1;
  }
  return pose_of(stance, joints);
}

BodyPose running_pose(const BodyStance& stance, double phase) {
  Joints joints;
  joints.bob = 0.05 * std::cos(2 * phase) - 0.01;
  joints.lean = 0.15;
  joints.yaw = 0.2 * std::sin(phase);
  for (const int side : {0, 1}) {
    const double own = phase + (side == 0 ? 0 : std::numbers::pi);
    joints.hip[side] = 0.25 + 0.65 * std::sin(own);
    joints.knee[side] = 0.35 + 1.3 * (1 + std::cos(own)) / 2;
    joints.swing[side] = -0.7 * std::sin(own);
    joints.aside[side] = 0.15;
    joints.elbow[side] = 1.5 - 0.2 * std::sin(own);
  }
  return pose_of(stance, joints);
}

BodyPose kneeling_pose(const BodyStance& stance, double time_s) {
  constexpr double kThigh = 0.43, kShank = 0.43, kFoot = 0.18, kHeel = 0.03, kSole = 0.045, kKnee = 0.06;  // m
  const double down = (1 - std::cos(1.2 * time_s)) / 2;  // 0: stands, 1: kneels on both knees
  Joints joints;
  joints.lean = 0.5 * down + 0.4 * down * (1 - down);
  joints.yaw = 0.2 * std::sin(0.9 * time_s);
  const double hip = 2.4 * down * (1 - down), knee = 1.94 * down + 1.4 * down * (1 - down);
  // On the knee, or on the toes.
  const double lean_back = knee - hip;
  const double below_knee = std::max(kKnee, (kShank + kHeel) * std::cos(lean_back) + kFoot * std::sin(lean_back) + kSole);
  joints.bob = kThigh * std::cos(hip) + below_knee - kHipHeight;
  for (const int side : {0, 1}) {
    joints.hip[side] = hip;
    joints.knee[side] = knee;
    joints.swing[side] = 0.3 + 0.9 * down + 0.2 * std::sin(1.7 * time_s + side);
    joints.aside[side] = 0.2;
    joints.elbow[side] = 0.3 + 0.4 * down;
  }
  return pose_of(stance, joints);
}

BodyPose rolling_pose(const BodyStance& stance, double time_s) {
  constexpr double kThick = 0.16;  // m
  const double rotated = 2 * std::numbers::pi * std::sin(0.45 * time_s);
  Joints joints;
  joints.tilt = geometry::rotation_from({0, -std::numbers::pi / 2, 0}) * turn_left(rotated);  // on the back, head behind
  const double aside = std::sin(rotated), prone = (1 - std::cos(rotated)) / 2;                // on an arm; on the toes
  joints.bob = 0.17 + 0.1 * aside * aside + 0.07 * prone - kHipHeight;
  for (const int side : {0, 1}) {
    joints.hip[side] = 0.15 + 0.15 * std::sin(0.9 * time_s + side);
    joints.knee[side] = 0.3 + 0.2 * std::sin(0.9 * time_s + side);
    joints.aside[side] = 0.02;
    joints.elbow[side] = 0.3;
  }
  BodyStance rolled = stance;  // to its side, as far as it turns
  rolled.x += -std::sin(stance.heading) * kThick * rotated;
  rolled.y += std::cos(stance.heading) * kThick * rotated;
  return pose_of(rolled, joints);
}

BodyPose upright_pose(const BodyStance& stance) {
  return pose_of(stance, {});
}

}  // namespace marey::simulate::room
