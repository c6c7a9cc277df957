#include "marey/analyse/gait/conventional_model.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "marey/analyse/gait/segment_axes.h"

namespace marey::analyse::gait {
namespace {

constexpr double kHipTheta = 0.5, kHipBeta = 0.314;  // rad: Davis 1991
constexpr int kSidedSegments = 7;
constexpr double kAlmostStraight = 0.087;  // sine of 5°: 2 cm of a forearm

std::optional<Vector<3>> location(const MarkerPositions& markers, std::string_view label) {
  const auto found = markers.find(label);
  return found == markers.end() ? std::nullopt : std::optional(found->second);
}

std::optional<Vector<3>> location(const MarkerPositions& markers, Side side, std::string_view label) {
  return location(markers, std::string(1, side == Side::left ? 'L' : 'R').append(label));
}

std::optional<Vector<3>> middle(const std::optional<Vector<3>>& a, const std::optional<Vector<3>>& b) {
  if (!a || !b) return a ? a : b;
  return Vector<3>(0.5 * (*a + *b));
}

/// The joint's centre below `above`: `offset` from the marker on its outside, with a right angle there, in the plane of a third
/// marker on the outside of the segment.
std::optional<Vector<3>> chord(const Vector<3>& above, const Vector<3>& outer, const Vector<3>& marker, double offset) {
  const Vector<3> along = marker - above;
  const double length = along.norm();
  if (!(length > offset)) return std::nullopt;
  const Vector<3> down = along / length, to_outer = outer - above, aside = to_outer - down * down.dot(to_outer);
  if (!(aside.norm() > 1e-6)) return std::nullopt;
  const double cosine = offset / length;
  return Vector<3>(marker - offset * (cosine * down + std::sqrt(1 - cosine * cosine) * aside.normalized()));
}

double leg_length(const GaitSubject& subject, Side side) {
  const auto& own = subject.leg_length[static_cast<std::size_t>(side)];
  return own.value_or(subject.leg_length[1 - static_cast<std::size_t>(side)].value_or(0.85));
}

/// A joint's width where it was not measured: shares of the leg's length, of the children and youths of the biomechZoo study.
double knee_width(const GaitSubject& subject, Side side) {
  return subject.knee_width[static_cast<std::size_t>(side)].value_or(0.115 * leg_length(subject, side));
}
double ankle_width(const GaitSubject& subject, Side side) {
  return subject.ankle_width[static_cast<std::size_t>(side)].value_or(0.083 * leg_length(subject, side));
}

/// An arm's measures likewise, left and right alike.
double shoulder_offset(const GaitSubject& subject, Side side) {
  return subject.shoulder_offset[static_cast<std::size_t>(side)].value_or(0.059 * leg_length(subject, side));
}
double elbow_width(const GaitSubject& subject, Side side) {
  return subject.elbow_width[static_cast<std::size_t>(side)].value_or(0.091 * leg_length(subject, side));
}
double wrist_width(const GaitSubject& subject, Side side) {
  return subject.wrist_width[static_cast<std::size_t>(side)].value_or(0.064 * leg_length(subject, side));
}
double hand_thickness(const GaitSubject& subject, Side side) {
  return subject.hand_thickness[static_cast<std::size_t>(side)].value_or(0.037 * leg_length(subject, side));
}

struct Hips {
  Rigid3 pelvis;
  std::array<Vector<3>, 2> centres;
};

std::optional<Hips> hips_of(const MarkerPositions& markers, const GaitSubject& subject) {
  const auto left = location(markers, "LASI"), right = location(markers, "RASI");
  const auto sacrum =
      location(markers, "SACR") ? location(markers, "SACR") : middle(location(markers, "LPSI"), location(markers, "RPSI"));
  if (!left || !right || !sacrum) return std::nullopt;
  const Vector<3> front = 0.5 * (*left + *right);
  const auto axes = axes_from(1, *left - *right, 0, front - *sacrum);
  if (!axes) return std::nullopt;
  Hips hips{.pelvis = {*axes, front}, .centres = {}};
  const double mean_leg = 0.5 * (leg_length(subject, Side::left) + leg_length(subject, Side::right));
  const double c = 0.115 * mean_leg - 0.0153, half = 0.5 * subject.asis_distance.value_or((*left - *right).norm());
  for (const Side side : kSides) {
    const double to_trochanter = 0.1288 * leg_length(subject, side) - 0.04856 + subject.marker_radius;
    const double x = c * std::cos(kHipTheta) * std::sin(kHipBeta) - to_trochanter * std::cos(kHipBeta);
    const double y = half - c * std::sin(kHipTheta);
    const double z = -c * std::cos(kHipTheta) * std::cos(kHipBeta) - to_trochanter * std::sin(kHipBeta);
    const Vector<3> by_regression(x, side == Side::left ? y : -y, z);
    const auto i = static_cast<std::size_t>(side);
    hips.centres[i] = hips.pelvis * subject.hip_in_pelvis[i].value_or(by_regression);
  }
  return hips;
}

/// The line from ankle to toe as a foot's x, before the sole is known.
std::optional<Matrix<3>> ankle_toe_axes(const Vector<3>& ankle, const Vector<3>& toe, const Matrix<3>& shank) {
  return axes_from(0, toe - ankle, 1, shank.col(1));
}

/// Of one leg: thigh, shank, foot.
void add_leg(const MarkerPositions& markers, const GaitSubject& subject, Side side, const Vector<3>& hip, GaitPose& pose) {
  const double outwards = side == Side::left ? 1 : -1;
  const auto thigh_marker = location(markers, side, "THI"), knee_marker = location(markers, side, "KNE");
  if (!thigh_marker || !knee_marker) return;
  const auto knee = chord(hip, *thigh_marker, *knee_marker, 0.5 * knee_width(subject, side) + subject.marker_radius);
  if (!knee) return;
  if (const auto axes = axes_from(2, hip - *knee, 1, outwards * (*knee_marker - *knee)))
    pose[of_side(SegmentId::left_thigh, side)] = Rigid3{*axes, hip};
  const auto shank_marker = location(markers, side, "TIB"), ankle_marker = location(markers, side, "ANK");
  if (!shank_marker || !ankle_marker) return;
  const auto ankle = chord(*knee, *shank_marker, *ankle_marker, 0.5 * ankle_width(subject, side) + subject.marker_radius);
  if (!ankle) return;
  const auto shank = axes_from(2, *knee - *ankle, 1, outwards * (*ankle_marker - *ankle));
  if (!shank) return;
  pose[of_side(SegmentId::left_shank, side)] = Rigid3{*shank, *knee};
  const auto toe = location(markers, side, "TOE");
  if (!toe) return;
  if (const auto foot = ankle_toe_axes(*ankle, *toe, *shank))
    pose[of_side(SegmentId::left_foot, side)] = Rigid3{*foot * subject.sole_from_ankle_toe[static_cast<std::size_t>(side)], *ankle};
}

void add_trunk(const MarkerPositions& markers, GaitPose& pose) {
  const auto c7 = location(markers, "C7"), t10 = location(markers, "T10"), clav = location(markers, "CLAV"),
             strn = location(markers, "STRN");
  if (c7 && clav && strn && t10) {
    if (const auto axes = axes_from(2, 0.5 * (*c7 + *clav) - 0.5 * (*t10 + *strn), 0, 0.5 * (*clav + *strn) - 0.5 * (*c7 + *t10)))
      pose[SegmentId::trunk] = Rigid3{*axes, 0.5 * (*t10 + *strn)};
  }
  const auto lf = location(markers, "LFHD"), rf = location(markers, "RFHD"), lb = location(markers, "LBHD"),
             rb = location(markers, "RBHD");
  if (!lf || !rf || !lb || !rb) return;
  if (const auto axes = axes_from(0, *lf + *rf - *lb - *rb, 1, *lf + *lb - *rf - *rb))
    pose[SegmentId::head] = Rigid3{*axes, 0.25 * (*lf + *rf + *lb + *rb)};
}

/// Where a forearm bends to, seen from the upper arm that runs along `down`: a direction across it. Of an elbow that is nearly
/// straight it would be noise, and turn over with it: there it passes to where the thumb's side points.
Vector<3> bends_to(const Vector<3>& down, const Vector<3>& forearm, const Vector<3>& thumb_side) {
  const Vector<3> d = down.normalized(), f = forearm.normalized();
  const Vector<3> across = f - d * d.dot(f), thumb = thumb_side - d * d.dot(thumb_side);
  const double straight = d.dot(f) > 0 ? std::max(0.0, 1 - across.norm() / kAlmostStraight) : 0;
  return (1 - straight) * across.normalized() + straight * thumb.normalized();
}

/// Where the clavicles hang on the trunk: behind the breastbone's upper marker.
Vector<3> clavicles_at(const Vector<3>& marker, const GaitSubject& subject, const Rigid3& trunk) {
  return marker - subject.marker_radius * trunk.rotation.col(0);
}

/// A shoulder's centre below its marker: with a right angle there, in the plane of the trunk's origin, the marker and what is up
/// across the trunk's x.
std::optional<Vector<3>> shoulder_of(const MarkerPositions& markers, const GaitSubject& subject, Side side, const Rigid3& trunk) {
  const auto marker = location(markers, side, "SHO"), clavicle = location(markers, "CLAV");
  if (!marker || !clavicle) return std::nullopt;
  const Vector<3> origin = clavicles_at(*clavicle, subject, trunk);
  Vector<3> up = (*marker - origin).cross(trunk.rotation.col(0));
  if (up.dot(trunk.rotation.col(2)) < 0) up = -up;
  return chord(origin, *marker + up.normalized(), *marker, shoulder_offset(subject, side) + subject.marker_radius);
}

struct Arm {
  Vector<3> shoulder, elbow, wrist, thumb_side, bar;  ///< the bar's middle, between the wrist's two markers
};

/// The elbow lies beside the plane of shoulder, elbow's marker and wrist, the wrist's centre on the palm's side of its markers.
std::optional<Arm> arm_of(const MarkerPositions& markers, const GaitSubject& subject, Side side, const Rigid3& trunk) {
  const auto shoulder = shoulder_of(markers, subject, side, trunk);
  const auto marker = location(markers, side, "ELB"), thumb = location(markers, side, "WRA"),
             little = location(markers, side, "WRB");
  if (!shoulder || !marker || !thumb || !little) return std::nullopt;
  Arm arm{.shoulder = *shoulder, .elbow = {}, .wrist = {}, .thumb_side = *thumb - *little, .bar = 0.5 * (*thumb + *little)};
  const double outwards = side == Side::left ? 1 : -1;
  const Vector<3> down = *marker - arm.shoulder, ahead = bends_to(down, arm.bar - *marker, arm.thumb_side);
  const auto elbow = chord(arm.shoulder, *marker + outwards * ahead.cross(down).normalized(), *marker,
                           0.5 * elbow_width(subject, side) + subject.marker_radius);
  if (!elbow) return std::nullopt;
  arm.elbow = *elbow;
  const Vector<3> to_palm = outwards * arm.thumb_side.cross(arm.elbow - arm.bar);
  arm.wrist = arm.bar + (0.5 * wrist_width(subject, side) + subject.marker_radius) * to_palm.normalized();
  return arm.wrist.allFinite() ? std::optional(arm) : std::nullopt;
}

/// Of one arm: clavicle, upper arm, forearm, hand. The elbow is a hinge: the upper arm's y is across the plane that it bends in, so
/// that its flexion is the angle between the two and has no sign to choose.
void add_arm(const MarkerPositions& markers, const GaitSubject& subject, Side side, GaitPose& pose) {
  const auto& trunk = pose[SegmentId::trunk];
  if (const auto clavicle = location(markers, "CLAV"); trunk && clavicle && location(markers, side, "SHO"))
    pose[of_side(SegmentId::left_clavicle, side)] = Rigid3{trunk->rotation, clavicles_at(*clavicle, subject, *trunk)};
  const auto arm = trunk ? arm_of(markers, subject, side, *trunk) : std::nullopt;
  if (!arm) return;
  const Vector<3> ahead = bends_to(arm->elbow - arm->shoulder, arm->wrist - arm->elbow, arm->thumb_side);
  if (const auto axes = axes_from(2, arm->shoulder - arm->elbow, 0, ahead))
    pose[of_side(SegmentId::left_upper_arm, side)] = Rigid3{*axes, arm->shoulder};
  const auto forearm = axes_from(2, arm->elbow - arm->wrist, 0, arm->thumb_side);
  if (!forearm) return;
  pose[of_side(SegmentId::left_forearm, side)] = Rigid3{*forearm, arm->elbow};
  const auto finger = location(markers, side, "FIN");
  if (!finger) return;
  const auto hand = chord(arm->wrist, arm->bar, *finger, 0.5 * hand_thickness(subject, side) + subject.marker_radius);
  if (!hand) return;
  if (const auto axes = axes_from(2, arm->wrist - *hand, 0, arm->thumb_side))
    pose[of_side(SegmentId::left_hand, side)] = Rigid3{*axes, arm->wrist};
}

constexpr std::array<std::pair<std::string_view, SegmentId>, 39> kMarkers = {{
    {"LFHD", SegmentId::head},
    {"RFHD", SegmentId::head},
    {"LBHD", SegmentId::head},
    {"RBHD", SegmentId::head},
    {"C7", SegmentId::trunk},
    {"T10", SegmentId::trunk},
    {"CLAV", SegmentId::trunk},
    {"STRN", SegmentId::trunk},
    {"RBAK", SegmentId::trunk},
    {"LSHO", SegmentId::left_clavicle},
    {"RSHO", SegmentId::right_clavicle},
    {"LELB", SegmentId::left_upper_arm},
    {"LWRA", SegmentId::left_forearm},
    {"LWRB", SegmentId::left_forearm},
    {"LFIN", SegmentId::left_hand},
    {"RELB", SegmentId::right_upper_arm},
    {"RWRA", SegmentId::right_forearm},
    {"RWRB", SegmentId::right_forearm},
    {"RFIN", SegmentId::right_hand},
    {"LASI", SegmentId::pelvis},
    {"RASI", SegmentId::pelvis},
    {"LPSI", SegmentId::pelvis},
    {"RPSI", SegmentId::pelvis},
    {"SACR", SegmentId::pelvis},
    {"LTHI", SegmentId::left_thigh},
    {"LKNE", SegmentId::left_thigh},
    {"LTIB", SegmentId::left_shank},
    {"LANK", SegmentId::left_shank},
    {"LHEE", SegmentId::left_foot},
    {"LTOE", SegmentId::left_foot},
    {"RTHI", SegmentId::right_thigh},
    {"RKNE", SegmentId::right_thigh},
    {"RTIB", SegmentId::right_shank},
    {"RANK", SegmentId::right_shank},
    {"RHEE", SegmentId::right_foot},
    {"RTOE", SegmentId::right_foot},
    {"LUPA", SegmentId::left_upper_arm},
    {"RUPA", SegmentId::right_upper_arm},
    {"LFRM", SegmentId::left_forearm},
}};

}  // namespace

std::string_view name_of(SegmentId segment) {
  constexpr std::array<std::string_view, kSegments> names = {
      "pelvis",         "trunk",           "head",          "left_thigh",    "left_shank",    "left_foot",
      "left_upper_arm", "left_forearm",    "left_hand",     "left_clavicle", "right_thigh",   "right_shank",
      "right_foot",     "right_upper_arm", "right_forearm", "right_hand",    "right_clavicle"};
  return names[static_cast<std::size_t>(segment)];
}

SegmentId of_side(SegmentId left, Side side) {
  return side == Side::left ? left : static_cast<SegmentId>(static_cast<int>(left) + kSidedSegments);
}

void GaitSubject::learn_from(const MarkerPositions& standing) {
  for (const Side side : kSides) {
    const auto i = static_cast<std::size_t>(side);
    const auto asis = location(standing, side, "ASI"), ankle = location(standing, side, "ANK");
    if (!leg_length[i] && asis && ankle) leg_length[i] = (*asis - *ankle).norm();
    sole_from_ankle_toe[i].setIdentity();
  }
  const GaitPose pose = pose_of(standing, *this);
  for (const Side side : kSides) {
    const auto& foot = pose[of_side(SegmentId::left_foot, side)];
    const auto& shank = pose[of_side(SegmentId::left_shank, side)];
    const auto heel = location(standing, side, "HEE"), toe = location(standing, side, "TOE");
    if (!foot || !shank || !heel || !toe) continue;
    if (const auto sole = axes_from(0, *toe - *heel, 1, shank->rotation.col(1)))
      sole_from_ankle_toe[static_cast<std::size_t>(side)] = foot->rotation.transpose() * *sole;
  }
}

GaitPose pose_of(const MarkerPositions& markers, const GaitSubject& subject) {
  GaitPose pose;
  add_trunk(markers, pose);
  for (const Side side : kSides) add_arm(markers, subject, side, pose);
  const auto hips = hips_of(markers, subject);
  if (!hips) return pose;
  pose[SegmentId::pelvis] = hips->pelvis;
  for (const Side side : kSides) add_leg(markers, subject, side, hips->centres[static_cast<std::size_t>(side)], pose);
  return pose;
}

std::span<const std::string_view> plug_in_gait_markers() {
  static const auto labels = [] {
    std::array<std::string_view, kMarkers.size()> all;
    std::transform(kMarkers.begin(), kMarkers.end(), all.begin(), [](const auto& marker) { return marker.first; });
    return all;
  }();
  return labels;
}

std::optional<SegmentId> segment_of_marker(std::string_view label) {
  const auto found = std::find_if(kMarkers.begin(), kMarkers.end(), [&](const auto& marker) { return marker.first == label; });
  return found == kMarkers.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace marey::analyse::gait
