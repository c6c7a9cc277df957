// A body of 15 capsules (a line and a radius) joined at the usual joints, moved by sines as a walker's joints nearly are: hip and
// knee after Winter, "Biomechanics and Motor Control of Human Movement", reduced to their first harmonics. Segment lengths are the
// usual shares of a height of 1.75 m. A marker is hidden where the line to the camera comes nearer to a capsule's line than its
// radius: 15 distances between two segments for each marker and camera.
#include "marey/simulate/room/body.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace marey::simulate::room {
namespace {

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

constexpr double kHipHeight = 0.93, kHipAside = 0.09, kShoulderUp = 0.40, kShoulderAside = 0.19;
constexpr double kStandOff = 0.008;  // m from the skin to a marker's centre

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
  double bob = 0;            // m that the pelvis is above its height
  double lean = 0, yaw = 0;  // of the chest against the pelvis
  double hip[2] = {0, 0};    // ahead; [0] is left
  double knee[2] = {0, 0};   // bent
  double swing[2] = {0, 0};  // shoulder, ahead
  double aside[2] = {0, 0};  // shoulder, away from the body
  double elbow[2] = {0, 0};  // bent ahead
  double wave[2] = {0, 0};   // forearm, away from the body
};

const Vector<3>& end_of(int limb) {
  return limb_shapes()[static_cast<std::size_t>(limb)].end;
}

void place_arm(BodyPose& pose, const Joints& joints, int side) {
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

void place_leg(BodyPose& pose, const Joints& joints, int side) {
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
  pose[pelvis].rotation = turn_left(stance.heading);
  pose[chest].translation = pose[pelvis] * Vector<3>(0, 0, 0.12);
  pose[chest].rotation = pose[pelvis].rotation * turn_left(joints.yaw) * swing_ahead(-joints.lean);
  pose[head].translation = pose[chest] * Vector<3>(0.02, 0, 0.55);
  pose[head].rotation = pose[pelvis].rotation;
  for (const int side : {0, 1}) {
    place_arm(pose, joints, side);
    place_leg(pose, joints, side);
  }
  return pose;
}

/// Squared distance between two lines' pieces (Ericson, "Real-Time Collision Detection", §5.1.9).
double squared_distance(const Vector<3>& p, const Vector<3>& p_end, const Vector<3>& q, const Vector<3>& q_end) {
  const Vector<3> d1 = p_end - p, d2 = q_end - q, r = p - q;
  const double a = d1.squaredNorm(), e = d2.squaredNorm(), f = d2.dot(r), c = d1.dot(r), b = d1.dot(d2);
  const double parallel = a * e - b * b;
  double s = parallel > 1e-12 ? std::clamp((b * f - c * e) / parallel, 0.0, 1.0) : 0.0;
  const double t = std::clamp((b * s + f) / e, 0.0, 1.0);
  s = std::clamp((b * t - c) / a, 0.0, 1.0);
  return (r + s * d1 - t * d2).squaredNorm();
}

double squared_distance(const Vector<3>& point, const Vector<3>& q, const Vector<3>& q_end) {
  const Vector<3> d = q_end - q;
  const double t = std::clamp(d.dot(point - q) / d.squaredNorm(), 0.0, 1.0);
  return (q + t * d - point).squaredNorm();
}

/// A place on the limb's side, `along` its length and `round` it.
Vector<3> on_limb(const LimbShape& limb, double along, double round) {
  const Vector<3> axis = limb.end.normalized();
  const Vector<3> across = axis.unitOrthogonal();
  return along * limb.end + (limb.radius + kStandOff) * (std::cos(round) * across + std::sin(round) * axis.cross(across));
}

bool inside_another(const BodyPose& pose, int own, const Vector<3>& world) {
  for (int i = 0; i < kLimbs; ++i) {
    const LimbShape& limb = limb_shapes()[static_cast<std::size_t>(i)];
    const Rigid3& at = pose[static_cast<std::size_t>(i)];
    const double reach = limb.radius + 2 * kStandOff;
    if (i != own && squared_distance(world, at.translation, at * limb.end) < reach * reach) return true;
  }
  return false;
}

int limb_by_surface(Random& random) {
  const auto surface = [](const LimbShape& limb) { return limb.radius * (limb.end.norm() + limb.radius); };
  double all = 0;
  for (const LimbShape& limb : limb_shapes()) all += surface(limb);
  double left = random.uniform(0, all);
  for (int i = 0; i < kLimbs; ++i) {
    left -= surface(limb_shapes()[static_cast<std::size_t>(i)]);
    if (left < 0) return i;
  }
  return kLimbs - 1;
}

}  // namespace

const std::array<LimbShape, kLimbs>& limb_shapes() {
  static const std::array<LimbShape, kLimbs> kShapes{{{"pelvis", {0, 0, 0.12}, 0.14},
                                                      {"chest", {0, 0, 0.40}, 0.13},
                                                      {"head", {0, 0, 0.14}, 0.09},
                                                      {"left_arm", {0, 0, -0.29}, 0.045},
                                                      {"left_forearm", {0, 0, -0.25}, 0.038},
                                                      {"left_hand", {0, 0, -0.10}, 0.032},
                                                      {"right_arm", {0, 0, -0.29}, 0.045},
                                                      {"right_forearm", {0, 0, -0.25}, 0.038},
                                                      {"right_hand", {0, 0, -0.10}, 0.032},
                                                      {"left_thigh", {0, 0, -0.43}, 0.07},
                                                      {"left_shank", {0, 0, -0.43}, 0.05},
                                                      {"left_foot", {0.18, 0, -0.03}, 0.035},
                                                      {"right_thigh", {0, 0, -0.43}, 0.07},
                                                      {"right_shank", {0, 0, -0.43}, 0.05},
                                                      {"right_foot", {0.18, 0, -0.03}, 0.035}}};
  return kShapes;
}

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

std::vector<BodyMarker> place_markers(int count, Random& random) {
  const BodyPose upright = standing_pose({});
  std::vector<BodyMarker> markers;
  std::vector<Vector<3>> places;
  std::array<int, kLimbs> on{};
  double apart = 0.12;  // m, given up little by little until all fit
  while (std::ssize(markers) < count) {
    const int limb = limb_by_surface(random);
    const LimbShape& shape = limb_shapes()[static_cast<std::size_t>(limb)];
    const Vector<3> in_limb = on_limb(shape, random.uniform(0.05, 0.95), random.uniform(0, 2 * std::numbers::pi));
    const Vector<3> place = upright[static_cast<std::size_t>(limb)] * in_limb;
    const bool free =
        std::all_of(places.begin(), places.end(), [&](const Vector<3>& other) { return (other - place).norm() > apart; });
    apart *= 0.999;
    if (!free || inside_another(upright, limb, place)) continue;
    places.push_back(place);
    markers.push_back({limb, in_limb, fmt::format("{}{}", shape.name, ++on[static_cast<std::size_t>(limb)])});
  }
  return markers;
}

Skeleton body_skeleton(std::span<const BodyMarker> markers) {
  constexpr std::array<int, kLimbs> kParents{-1,        pelvis, chest,   chest,   arm_l,  forearm_l, chest,  arm_r,
                                             forearm_r, pelvis, thigh_l, shank_l, pelvis, thigh_r,   shank_r};
  const BodyPose rest = pose_of({}, {});
  Skeleton skeleton;
  skeleton.name = "body";
  const auto add_axis = [&](Segment& segment, bool turns, int axis) {
    Coordinate coordinate;
    coordinate.name = segment.name + (turns ? "_r" : "_t") + "xyz"[axis];
    coordinate.turns = turns;
    segment.joint.axes.push_back({turns, Vector<3>::Unit(axis), {}, static_cast<int>(skeleton.coordinates.size())});
    skeleton.coordinates.push_back(std::move(coordinate));
  };
  for (std::size_t limb = 0; limb < kLimbs; ++limb) {
    Segment segment{.name = std::string(limb_shapes()[limb].name), .parent = {}, .joint = {}, .end = limb_shapes()[limb].end};
    if (kParents[limb] >= 0) {
      segment.parent = kParents[limb];
      segment.joint.parent_from_joint.translation =
          rest[static_cast<std::size_t>(kParents[limb])].inverse() * rest[limb].translation;
    } else {
      for (const int axis : {0, 1, 2}) add_axis(segment, false, axis);
    }
    const bool fixed = limb == hand_l || limb == hand_r || limb == foot_l || limb == foot_r;
    for (const int axis : {2, 1, 0}) {
      if (!fixed) add_axis(segment, true, axis);
    }
    skeleton.segments.push_back(std::move(segment));
  }
  for (const BodyMarker& marker : markers) skeleton.markers.push_back({marker.label, marker.limb, marker.in_limb, 1});
  return skeleton;
}

bool hidden_by_body(const BodyPose& pose, const Vector<3>& from, const Vector<3>& to) {
  for (std::size_t i = 0; i < kLimbs; ++i) {
    const LimbShape& limb = limb_shapes()[i];
    if (squared_distance(from, to, pose[i].translation, pose[i] * limb.end) < limb.radius * limb.radius) return true;
  }
  return false;
}

}  // namespace marey::simulate::room
