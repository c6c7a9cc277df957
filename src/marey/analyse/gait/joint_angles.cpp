#include "marey/analyse/gait/joint_angles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "marey/core/skeleton.h"

namespace marey::analyse::gait {
namespace {

constexpr double kPlaneKnown = 0.09;  // rad: an arm that hangs down has no plane of elevation

/// Turns about the upper segment's sideways axis, the floating one, the lower segment's long axis.
std::optional<Vector<3>> cardan(const std::optional<Rigid3>& upper, const std::optional<Rigid3>& lower) {
  if (!upper || !lower) return std::nullopt;
  Matrix<3> axes;
  axes << Vector<3>::UnitY(), Vector<3>::UnitX(), Vector<3>::UnitZ();
  return rotations_about(upper->rotation.transpose() * lower->rotation, axes, Vector<3>::Zero());
}

/// One side's angles, as names without the side. The mirror image of a turn about x or z has the other sign.
class SideAngles {
 public:
  SideAngles(const GaitPose& pose, Side side, const Rigid3& walking)
      : pose_(pose), side_(side), mirror_(side == Side::left ? -1 : 1), walking_(walking) {}

  template <typename Take>
  void notify(Take&& take) const {
    three(take, "pelvis", cardan(walking_, pose_[SegmentId::pelvis]), {"tilt", 1}, {"obliquity", -1}, {"rotation", 1});
    three(take, "trunk", cardan(walking_, pose_[SegmentId::trunk]), {"tilt", 1}, {"obliquity", -1}, {"rotation", 1});
    three(take, "spine", cardan(pose_[SegmentId::pelvis], pose_[SegmentId::trunk]), {"flexion", 1}, {"lateral_bending", -1},
          {"rotation", 1});
    three(take, "hip", cardan(pose_[SegmentId::pelvis], of(SegmentId::left_thigh)), {"flexion", -1}, {"adduction", 1},
          {"rotation", 1});
    three(take, "knee", cardan(of(SegmentId::left_thigh), of(SegmentId::left_shank)), {"flexion", 1}, {"adduction", 1},
          {"rotation", 1});
    three(take, "ankle", cardan(of(SegmentId::left_shank), of(SegmentId::left_foot)), {"dorsiflexion", -1}, {"inversion", 1},
          {"rotation", 1});
    // In the walking direction's frame: toes up, turned about the line to the toes, toes inwards.
    three(take, "foot", cardan(walking_, of(SegmentId::left_foot)), {"pitch", -1}, {"roll", 1}, {"progression", 1});
    shoulder(take);
    three(take, "elbow", cardan(of(SegmentId::left_upper_arm), of(SegmentId::left_forearm)), {"flexion", -1}, {"adduction", 1},
          {"pronation", 1});
    three(take, "wrist", cardan(of(SegmentId::left_forearm), of(SegmentId::left_hand)), {"radial_deviation", -1}, {"flexion", 1},
          {"rotation", 1});
  }

 private:
  struct Named {
    const char* name;
    double sign;
  };

  const std::optional<Rigid3>& of(SegmentId left) const { return pose_[of_side(left, side_)]; }

  template <typename Take>
  void three(Take&& take, const char* joint, const std::optional<Vector<3>>& rotations, Named sideways, Named floating,
             Named along) const {
    const auto one = [&](const Named& named, int i, double mirror) {
      take(joint, named.name, rotations ? std::optional(named.sign * mirror * (*rotations)[i]) : std::nullopt);
    };
    one(sideways, 0, 1);
    one(floating, 1, mirror_);
    one(along, 2, mirror_);
  }

  /// R = Rz(plane)·Rx(elevation)·Rz(rotation): the ISB's Y-X-Y, whose y is up.
  template <typename Take>
  void shoulder(Take&& take) const {
    const auto& trunk = pose_[SegmentId::trunk];
    const auto& arm = of(SegmentId::left_upper_arm);
    std::optional<double> plane, elevation, rotation;
    if (trunk && arm) {
      const Matrix<3> r = trunk->rotation.transpose() * arm->rotation;
      elevation = std::acos(std::clamp(r(2, 2), -1.0, 1.0));
      if (*elevation > kPlaneKnown && *elevation < std::numbers::pi - kPlaneKnown) {
        // 0: sideways, 90°: ahead.
        plane = std::atan2(-r(0, 2), side_ == Side::left ? -r(1, 2) : r(1, 2));
        rotation = mirror_ * std::atan2(r(2, 0), side_ == Side::left ? r(2, 1) : -r(2, 1));
      }
    }
    take("shoulder", "plane", plane);
    take("shoulder", "elevation", elevation);
    take("shoulder", "rotation", rotation);
  }

  const GaitPose& pose_;
  Side side_;
  double mirror_;
  std::optional<Rigid3> walking_;
};

template <typename Take>
void for_each_angle(const GaitPose& pose, const Vector<2>& heading, Take&& take) {
  Rigid3 walking;
  if (heading.norm() > 1e-9) {
    const Vector<2> h = heading.normalized();
    walking.rotation << h.x(), -h.y(), 0, h.y(), h.x(), 0, 0, 0, 1;
  }
  for (const Side side : kSides) {
    SideAngles(pose, side, walking).notify([&](const char* joint, const char* name, const std::optional<double>& angle) {
      take(side, joint, name, angle);
    });
  }
}

}  // namespace

std::span<const std::string> angle_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for_each_angle({}, Vector<2>::UnitX(), [&](Side side, const std::string& joint, const std::string& name, const auto&) {
      all.push_back(fmt::format("{}_{}_{}", side == Side::left ? "left" : "right", joint, name));
    });
    return all;
  }();
  return names;
}

std::vector<std::optional<double>> angles_of(const GaitPose& pose, const Vector<2>& heading) {
  std::vector<std::optional<double>> angles;
  angles.reserve(angle_names().size());
  for_each_angle(pose, heading,
                 [&](Side, const char*, const char*, const std::optional<double>& angle) { angles.push_back(angle); });
  return angles;
}

void unwrap(std::span<std::optional<double>> angles) {
  std::optional<double> before;
  for (std::optional<double>& angle : angles) {
    if (!angle) continue;
    if (before) *angle += 2 * std::numbers::pi * std::round((*before - *angle) / (2 * std::numbers::pi));
    before = angle;
  }
}

}  // namespace marey::analyse::gait
