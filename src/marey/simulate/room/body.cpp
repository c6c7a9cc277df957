// A body of 15 capsules (a line and a radius) joined at the typical joints. Segment lengths are the typical shares of a height of
// 1.75 m. A marker is hidden where the line to the camera comes nearer to a capsule's line than its radius: 15 distances between
// two segments for each marker and camera. Skin slides over the bone as joints bend, most on the thigh (Leardini et al., "Human
// movement analysis using stereophotogrammetry. Part 3", Gait & Posture 21, 2005: up to 30 mm there, 10 to 15 mm on the shank).
#include "marey/simulate/room/body.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace marey::simulate::room {
namespace {

constexpr double kStandOff = 0.008;  // m from the skin to a marker's centre
constexpr std::array<int, kLimbs> kParents{-1,        pelvis, chest,   chest,   arm_l,  forearm_l, chest,  arm_r,
                                           forearm_r, pelvis, thigh_l, shank_l, pelvis, thigh_r,   shank_r};
// Of what a thigh's skin slides: by limb.
constexpr std::array<double, kLimbs> kSkin{0.3, 0.3, 0.05, 0.6, 0.4, 0.1, 0.6, 0.4, 0.1, 1, 0.5, 0.15, 1, 0.5, 0.15};

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

std::vector<BodyMarker> position_markers(int count, Random& random) {
  const BodyPose upright = standing_pose({});
  std::vector<BodyMarker> markers;
  std::vector<Vector<3>> locations;
  std::array<int, kLimbs> on{};
  double apart = 0.12;  // m, given up little by little until all fit
  while (std::ssize(markers) < count) {
    const int limb = limb_by_surface(random);
    const LimbShape& shape = limb_shapes()[static_cast<std::size_t>(limb)];
    const double angle = random.uniform(0, 2 * std::numbers::pi), along = random.uniform(0.05, 0.95);  // in this order
    const Vector<3> in_limb = on_limb(shape, along, angle);
    const Vector<3> location = upright[static_cast<std::size_t>(limb)] * in_limb;
    const bool free =
        std::all_of(locations.begin(), locations.end(), [&](const Vector<3>& other) { return (other - location).norm() > apart; });
    apart *= 0.999;
    if (!free || inside_another(upright, limb, location)) continue;
    locations.push_back(location);
    markers.push_back({limb, in_limb, fmt::format("{}{}", shape.name, ++on[static_cast<std::size_t>(limb)])});
  }
  return markers;
}

Skeleton body_skeleton(std::span<const BodyMarker> markers) {
  const BodyPose rest = upright_pose({});
  Skeleton skeleton;
  skeleton.name = "body";
  const auto add_axis = [&](Segment& segment, bool is_rotation, int axis) {
    Coordinate coordinate;
    coordinate.name = segment.name + (is_rotation ? "_r" : "_t") + "xyz"[axis];
    coordinate.is_rotation = is_rotation;
    segment.joint.axes.push_back({is_rotation, Vector<3>::Unit(axis), {}, static_cast<int>(skeleton.coordinates.size())});
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

namespace {

/// Of the limb against the one it hangs on; the pelvis' against the world.
Matrix<3> turn_of(const BodyPose& pose, std::size_t limb) {
  if (kParents[limb] < 0) return pose[limb].rotation;
  return pose[static_cast<std::size_t>(kParents[limb])].rotation.transpose() * pose[limb].rotation;
}

}  // namespace

std::vector<double> body_coordinates(const BodyPose& pose) {
  std::vector<double> coordinates;
  for (std::size_t limb = 0; limb < kLimbs; ++limb) {
    if (limb == pelvis) coordinates.insert(coordinates.end(), pose[limb].translation.begin(), pose[limb].translation.end());
    if (limb == hand_l || limb == hand_r || limb == foot_l || limb == foot_r) continue;
    const Matrix<3> turn = turn_of(pose, limb);  // Rz Ry Rx
    coordinates.push_back(std::atan2(turn(1, 0), turn(0, 0)));
    coordinates.push_back(-std::asin(std::clamp(turn(2, 0), -1.0, 1.0)));
    coordinates.push_back(std::atan2(turn(2, 1), turn(2, 2)));
  }
  return coordinates;
}

Vector<3> on_skin(const BodyPose& pose, const BodyMarker& marker, double skin_m) {
  const auto limb = static_cast<std::size_t>(marker.limb);
  if (skin_m <= 0) return pose[limb] * marker.in_limb;
  double bend = limb == pelvis ? 0 : geometry::angle_axis_of(turn_of(pose, limb)).norm();
  for (std::size_t other = 0; other < kLimbs; ++other) {
    if (kParents[other] == marker.limb) bend = std::max(bend, geometry::angle_axis_of(turn_of(pose, other)).norm());
  }
  const double slid = skin_m * kSkin[limb] * std::min(1.0, bend / (std::numbers::pi / 2));
  const Vector<3> along = limb_shapes()[limb].end.normalized();
  const Vector<3> out = (marker.in_limb - along * along.dot(marker.in_limb)).normalized();
  return pose[limb] * (marker.in_limb - slid * (0.9 * along + 0.436 * along.cross(out)));  // towards the joint, and round the limb
}

bool hidden_by_body(const BodyPose& pose, const Vector<3>& from, const Vector<3>& to) {
  for (std::size_t i = 0; i < kLimbs; ++i) {
    const LimbShape& limb = limb_shapes()[i];
    if (squared_distance(from, to, pose[i].translation, pose[i] * limb.end) < limb.radius * limb.radius) return true;
  }
  return false;
}

}  // namespace marey::simulate::room
