#include "marey/pipeline/bodies/human_skeleton.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/pipeline/bodies/gait_markers.h"
#include "marey/pipeline/bodies/joints_by_motion.h"
#include "marey/solve/skeleton/human.h"

namespace marey::pipeline::bodies {
namespace {

// Assumed, not measured here: how far Davis' regression is off people's true hips, one standard deviation of all three directions.
constexpr double kRegressionM = 0.020;
constexpr double kVagueM = 0.035;  // a motion that says less than this says nothing beside the regression
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kNeckFraction = 0.3;                 // of the distance from there to the head's middle
constexpr double kConventionalAxisRad = 8 * kDegree;  // assumed: how well markers on thighs and arms are put by eye
constexpr double kSkinAxisRad = 5 * kDegree;          // assumed: what skin does that the jackknife does not see
constexpr double kVagueAxisRad = 10 * kDegree;
constexpr double kOtherAxisRad = 35 * kDegree;  // that is not a knee's axis, or markers were exchanged

const char* side_name(gait::Side side) {
  return side == gait::Side::left ? "left" : "right";
}

/// The hip between where the regression and the motion have it, each by its precision.
FoundJoint position_hip(gait::Side side, const gait::GaitPose& standing,
                        const std::optional<solve::skeleton::FunctionalCentre>& found, gait::GaitSubject& subject) {
  FoundJoint joint{.name = std::string(side_name(side)) + " hip", .by_motion = false, .deviation = 0, .moved = 0, .stated = {}};
  const auto& thigh = standing[gait::of_side(gait::SegmentId::left_thigh, side)];
  const auto& pelvis = standing[gait::SegmentId::pelvis];
  if (!found || !thigh || !pelvis) {
    joint.stated = joint.name + ": the motion does not determine its centre; the regression's stays";
    return joint;
  }
  if (found->deviation_m > kVagueM) {
    joint.stated = fmt::format("{}: the motion determines its centre to ±{:.0f} mm only; the regression's stays", joint.name,
                               1000 * found->deviation_m);
    return joint;
  }
  const double by_motion = 1 / (found->deviation_m * found->deviation_m), by_regression = 1 / (kRegressionM * kRegressionM);
  const Vector<3> centre = (by_motion * found->in_parent + by_regression * thigh->translation) / (by_motion + by_regression);
  subject.hip_in_pelvis[static_cast<std::size_t>(side)] = pelvis->inverse() * centre;
  joint.by_motion = true;
  joint.deviation = 1 / std::sqrt(by_motion + by_regression);
  joint.moved = (centre - thigh->translation).norm();
  joint.stated =
      fmt::format("{}: by the motion (±{:.0f} mm) and the regression together, ±{:.0f} mm, {:.0f} mm from the regression",
                  joint.name, 1000 * found->deviation_m, 1000 * joint.deviation, 1000 * joint.moved);
  return joint;
}

/// A segment's frame turned about its own length so that its y is along the axis as far as it can be.
Matrix<3> rotated_to(const Matrix<3>& frame, const Vector<3>& up, const Vector<3>& axis) {
  const Vector<3> z = up.normalized(), along = axis.dot(frame.col(1)) < 0 ? Vector<3>(-axis) : axis;
  const Vector<3> y = (along - z * z.dot(along)).normalized();
  Matrix<3> rotated;
  rotated << y.cross(z), y, z;
  return rotated;
}

/// The hinge between two segments of the standing pose gets an axis between the conventional one and the motion's, each by its
/// precision; a knee goes to the nearest place on the motion's.
FoundJoint turn_hinge(const std::string& name, gait::SegmentId upper, gait::SegmentId lower, gait::SegmentId last,
                      bool moves_centre, const std::optional<solve::skeleton::FunctionalAxis>& found, gait::GaitPose& pose) {
  FoundJoint joint{.name = name, .by_motion = false, .deviation = 0, .moved = 0, .stated = {}};
  if (!found || !pose[upper] || !pose[lower]) {
    joint.stated = name + ": the motion does not determine its axis; the conventional one stays";
    return joint;
  }
  Rigid3 &above = *pose[upper], &below = *pose[lower];
  const Vector<3> conventional = above.rotation.col(1);
  const Vector<3> moved = found->direction.dot(conventional) < 0 ? Vector<3>(-found->direction) : found->direction;
  const double off = std::acos(std::min(1.0, moved.dot(conventional))), deviation = std::hypot(found->deviation_rad, kSkinAxisRad);
  if (deviation > kVagueAxisRad || off > kOtherAxisRad) {
    joint.stated = fmt::format("{}: the motion has its axis ±{:.0f}° and {:.0f}° from the conventional one, which stays", name,
                               deviation / kDegree, off / kDegree);
    return joint;
  }
  const double by_motion = 1 / (deviation * deviation), by_markers = 1 / (kConventionalAxisRad * kConventionalAxisRad);
  const Vector<3> axis = (by_motion * moved + by_markers * conventional).normalized();
  if (moves_centre) below.translation = found->point + found->direction * found->direction.dot(below.translation - found->point);
  above.rotation = rotated_to(above.rotation, above.translation - below.translation, axis);
  const Vector<3> down = pose[last] ? Vector<3>(below.translation - pose[last]->translation) : Vector<3>(below.rotation.col(2));
  if (moves_centre) below.rotation = rotated_to(below.rotation, down, axis);
  joint.by_motion = true;
  joint.deviation = 1 / std::sqrt(by_motion + by_markers);
  joint.moved = std::acos(std::min(1.0, axis.dot(conventional)));
  joint.stated = fmt::format(
      "{}: axis by the motion (±{:.0f}°; it bent through {:.0f}°) and the markers together, ±{:.0f}°, {:.0f}° from the markers' "
      "alone",
      name, deviation / kDegree, found->rotated_rad / kDegree, joint.deviation / kDegree, joint.moved / kDegree);
  return joint;
}

/// What the conventional model is given: where a joint's inner side was marked too, its width, and in the wand's place the line
/// through both sides.
gait::MarkerPositions for_the_model(const gait::MarkerPositions& standing, gait::GaitSubject& subject) {
  gait::MarkerPositions locations = standing;
  const auto widen = [&](const std::string& outer, const std::string& inner, const std::string& wand,
                         std::optional<double>& width) {
    const auto outside = standing.find(outer), inside = standing.find(inner);
    if (outside == standing.end() || inside == standing.end()) return;
    width = std::max(0.02, (outside->second - inside->second).norm() - 2 * subject.marker_radius);
    locations[wand] = 2 * outside->second - inside->second;
  };
  for (const gait::Side side : gait::kSides) {
    const std::string letter = side == gait::Side::left ? "L" : "R";
    widen(letter + "KNE", letter + "KNM", letter + "THI", subject.knee_width[static_cast<std::size_t>(side)]);
    widen(letter + "ANK", letter + "ANM", letter + "TIB", subject.ankle_width[static_cast<std::size_t>(side)]);
  }
  return locations;
}

gait::GaitPose pose_by_motion(const gait::MarkerPositions& standing, const gait::MarkerPositions& model, gait::GaitSubject& subject,
                              const GaitMarkers& motion, std::vector<FoundJoint>& joints) {
  const gait::GaitPose conventional = gait::pose_of(model, subject);
  const JointsByMotion by_motion(standing, conventional, motion);
  for (const gait::Side side : gait::kSides) joints.push_back(position_hip(side, conventional, by_motion.hip(side), subject));
  gait::GaitPose pose = gait::pose_of(model, subject);
  for (const gait::Side side : gait::kSides) {
    using gait::SegmentId;
    const auto of = [&](SegmentId left) { return gait::of_side(left, side); };
    const auto& thigh = pose[of(SegmentId::left_thigh)];
    joints.push_back(turn_hinge(std::string(side_name(side)) + " knee", of(SegmentId::left_thigh), of(SegmentId::left_shank),
                                of(SegmentId::left_foot), true, thigh ? by_motion.knee(side, thigh->translation) : std::nullopt,
                                pose));
    if (!pose[of(SegmentId::left_upper_arm)]) continue;
    joints.push_back(turn_hinge(std::string(side_name(side)) + " elbow", of(SegmentId::left_upper_arm), of(SegmentId::left_forearm),
                                of(SegmentId::left_hand), false, by_motion.elbow(side), pose));
  }
  return pose;
}

/// The required markers of a pelvis, in the set's own labels; throws Error if it is not there.
void need_a_pelvis(const gait::GaitPose& pose, const gait::MarkerPositions& standing, const gait::BodyMarkerSet& set,
                   const std::string& path) {
  if (pose[gait::SegmentId::pelvis]) return;
  std::vector<std::string> required, lacking;
  for (const char* key : {"LASI", "RASI", "SACR", "LPSI", "RPSI"}) {
    if (!set.segment_of(key)) continue;
    required.push_back(set.label_of(key));
    if (!standing.contains(key)) lacking.push_back(set.label_of(key));
  }
  const bool either = set.segment_of("SACR") && set.segment_of("LPSI");
  throw Error("{}: the pelvis is not known, with which a skeleton begins: {} show it{}, and {} not seen", path,
              fmt::join(required, ", "), either ? fmt::format(" ({} or the two behind it)", set.label_of("SACR")) : "",
              lacking.empty() ? "they lie in a line or are"
                              : fmt::format("{} {}", fmt::join(lacking, ", "), lacking.size() == 1 ? "is" : "are"));
}

std::optional<Vector<3>> midway(const gait::MarkerPositions& standing, const std::string& a, const std::string& b) {
  const auto at = standing.find(a), there = standing.find(b);
  if (at == standing.end() || there == standing.end()) return std::nullopt;
  return Vector<3>(0.5 * (at->second + there->second));
}

/// A head's own joint: where the neck begins, between C7 and the collarbones; its frame's origin is the head's middle.
std::optional<Vector<3>> neck_of(const gait::MarkerPositions& standing, const gait::GaitPose& pose) {
  const auto base = midway(standing, "C7", "CLAV");
  const auto& head = pose[gait::SegmentId::head];
  if (!base || !head) return std::nullopt;
  return Vector<3>(*base + kNeckFraction * (head->translation - *base));
}

/// Where a segment ends on which nothing hangs: a foot at its toe's marker, a hand at its knuckle, the head at its top.
std::optional<Vector<3>> end_of(gait::SegmentId segment, const gait::MarkerPositions& standing, const gait::GaitPose& pose) {
  using gait::SegmentId;
  const auto& own = pose[segment];
  if (!own) return std::nullopt;
  if (segment == SegmentId::trunk) return midway(standing, "C7", "CLAV");
  if (segment == SegmentId::head) {
    const auto front = midway(standing, "LFHD", "RFHD"), back = midway(standing, "LBHD", "RBHD");
    const auto& trunk = pose[SegmentId::trunk];
    if (!front || !back || !trunk) return std::nullopt;
    return Vector<3>(own->translation + 0.5 * (*front - *back).norm() * trunk->rotation.col(2));
  }
  for (const gait::Side side : gait::kSides) {
    const std::string letter = side == gait::Side::left ? "L" : "R";
    if (segment == gait::of_side(SegmentId::left_foot, side)) return midway(standing, letter + "TOE", letter + "TOE");
    if (segment == gait::of_side(SegmentId::left_forearm, side)) return midway(standing, letter + "WRA", letter + "WRB");
    if (segment == gait::of_side(SegmentId::left_clavicle, side)) return midway(standing, letter + "SHO", letter + "SHO");
    const auto finger = midway(standing, letter + "FIN", letter + "FIN");
    if (segment != gait::of_side(SegmentId::left_hand, side) || !finger) continue;
    const Vector<3> along = own->rotation.col(2);
    return Vector<3>(own->translation + along * along.dot(*finger - own->translation));
  }
  return std::nullopt;
}

/// The message if neither the file nor markers on both sides specify how wide the legs' joints are.
std::optional<std::string> widths_assumed(const gait::GaitSubject& subject, const std::string& path) {
  const auto known = [](const std::optional<double>& width) { return width.has_value(); };
  const auto all = [&](const auto& widths) { return std::all_of(widths.begin(), widths.end(), known); };
  if (all(subject.knee_width) && all(subject.ankle_width)) return std::nullopt;
  return fmt::format(
      "{}: how wide knees and ankles are is not known (Vicon's C3D files tell it, markers on both sides of a joint show it): "
      "shares "
      "of the legs' length are taken",
      path);
}

/// Of markers in one posture; `path` is the file that they are of.
HumanSkeleton human_of(const gait::MarkerPositions& standing, const std::string& path, const gait::BodyMarkerSet& set,
                       gait::GaitSubject& subject, const HumanOptions& options, const Hooks& hooks) {
  const gait::MarkerPositions model = for_the_model(standing, subject);
  subject.learn_from(model);
  HumanSkeleton human;
  human.marker_set = set.title();
  human.set = &set;
  human.standing = standing;
  if (auto message_text = widths_assumed(subject, path)) human.warnings.push_back(std::move(*message_text));
  gait::GaitPose pose = gait::pose_of(model, subject);
  need_a_pelvis(pose, standing, set, path);
  if (!options.motion.empty()) {
    const GaitMarkers moving = read_gait_markers(options.motion, options.up, hooks, set);
    pose = pose_by_motion(standing, model, subject, moving, human.joints);
    human.warnings.insert(human.warnings.end(), moving.warnings.begin(), moving.warnings.end());
    if (const auto other = other_person(standing, moving))
      human.warnings.push_back(
          fmt::format("{} is of another person than {}, or markers were put on again: {}", options.motion, path, *other));
  }
  std::vector<solve::skeleton::StandingSegment> segments;
  for (std::size_t s = 0; s < gait::kSegments; ++s) {
    const auto segment = static_cast<gait::SegmentId>(s);
    if (!pose.world_from[s]) continue;
    segments.push_back({std::string(gait::name_of(segment)), *pose.world_from[s], end_of(segment, standing, pose)});
    if (segment == gait::SegmentId::head)
      segments.back().world_from.translation = neck_of(standing, pose).value_or(pose.world_from[s]->translation);
  }
  std::vector<solve::skeleton::StandingMarker> markers;
  for (const auto& [key, location] : standing)
    markers.push_back({set.label_of(key), std::string(gait::name_of(*set.segment_of(key))), location});
  human.skeleton = solve::skeleton::human_skeleton(std::filesystem::path(path).stem().string(), segments, markers);
  return human;
}
}  // namespace

HumanSkeleton human_from_static(const std::string& path, const HumanOptions& options, const Hooks& hooks) {
  const gait::BodyMarkerSet& set = marker_set_of(path, options.marker_set);
  gait::GaitSubject subject;
  take_measures(path, subject);
  const gait::MarkerPositions standing = standing_positions(read_gait_markers(path, options.up, hooks, set), path);
  return human_of(standing, path, set, subject, options, hooks);
}

HumanSkeleton human_from_motion(const std::string& path, const HumanOptions& options, const Hooks& hooks) {
  const gait::BodyMarkerSet& set = marker_set_of(path, options.marker_set);
  gait::GaitSubject subject;
  take_measures(path, subject);
  const QuietTimeStep quiet = quietest_time_step(read_gait_markers(path, options.up, hooks, set), path);
  HumanSkeleton human = human_of(quiet.locations, path, set, subject, options, hooks);
  const std::string how = quiet.stands ? "stands still" : fmt::format("is quietest (markers move at {:.1f} m/s)", quiet.speed_m_s);
  human.warnings.insert(human.warnings.begin(),
                        fmt::format("{}: without --static-trial the skeleton is calibrated from this motion alone, by the posture "
                                    "at {:.2f} s, where the person "
                                    "{}, then by all of it, left and right alike; one of a static trial is surer",
                                    path, quiet.time_s, how));
  return human;
}

}  // namespace marey::pipeline::bodies
