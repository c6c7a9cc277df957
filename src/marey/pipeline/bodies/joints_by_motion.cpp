#include "marey/pipeline/bodies/joints_by_motion.h"

#include <algorithm>
#include <utility>

#include <Eigen/Eigenvalues>

#include "marey/geometry/layout.h"

namespace marey::pipeline::bodies {
namespace {

constexpr int kRounds = 3;             // of knee and hip, each by the other
constexpr double kAlmostALine = 0.01;  // m, RMS of a cluster across its length

/// Whether the places fix a frame: three at least, not in a line.
bool fixes_a_frame(const std::vector<Vector<3>>& locations) {
  if (locations.size() < 3) return false;
  Vector<3> mean = Vector<3>::Zero();
  for (const Vector<3>& location : locations) mean += location / static_cast<double>(locations.size());
  Matrix<3> spread = Matrix<3>::Zero();
  for (const Vector<3>& location : locations)
    spread += (location - mean) * (location - mean).transpose() / static_cast<double>(locations.size());
  return Eigen::SelfAdjointEigenSolver<Matrix<3>>(spread).eigenvalues()[1] > kAlmostALine * kAlmostALine;
}

std::string of_side(gait::Side side, const char* label) {
  return std::string(side == gait::Side::left ? "L" : "R") + label;
}

}  // namespace

JointsByMotion::JointsByMotion(const gait::MarkerPositions& standing, gait::GaitPose conventional, const GaitMarkers& motion)
    : standing_(standing),
      conventional_(std::move(conventional)),
      motion_(motion),
      pelvis_(poses_of(labels_of(gait::SegmentId::pelvis))) {}

bool JointsByMotion::predominantly_observed(const std::string& label) const {
  const auto detected = std::count_if(motion_.rows.begin(), motion_.rows.end(),
                                      [&](const gait::MarkerPositions& row) { return row.contains(label); });
  return 2 * detected > std::ssize(motion_.rows);
}

std::vector<std::string> JointsByMotion::labels_of(gait::SegmentId segment) const {
  std::vector<std::string> labels;
  for (const auto& [label, location] : standing_) {
    if (motion_.set->segment_of(label) == segment && predominantly_observed(label)) labels.push_back(label);
  }
  return labels;
}

JointsByMotion::Poses JointsByMotion::poses_of(const std::vector<std::string>& labels, const std::vector<Carried>& carried) const {
  Poses poses(motion_.rows.size());
  std::vector<Vector<3>> from, to;
  for (const std::string& label : labels) from.push_back(standing_.at(label));
  for (const Carried& point : carried) from.push_back(point.location);
  if (!fixes_a_frame(from)) return poses;
  for (std::size_t r = 0; r < poses.size(); ++r) {
    to.clear();
    for (const std::string& label : labels) {
      const auto detected = motion_.rows[r].find(label);
      if (detected != motion_.rows[r].end()) to.push_back(detected->second);
    }
    for (const Carried& point : carried) {
      if (const auto& by = (*point.by)[r]) to.push_back(*by * point.location);
    }
    if (to.size() == from.size()) poses[r] = geometry::rigid_fit(from, to);
  }
  return poses;
}

/// The marker at the knee's outside lies near its axis, and stays where it is in the shank too.
JointsByMotion::Poses JointsByMotion::shank_poses(gait::Side side) const {
  std::vector<std::string> labels = labels_of(gait::of_side(gait::SegmentId::left_shank, side));
  const std::string knee = of_side(side, "KNE");
  if (standing_.contains(knee) && predominantly_observed(knee)) labels.push_back(knee);
  return poses_of(labels);
}

std::optional<solve::skeleton::FunctionalCentre> JointsByMotion::hip(gait::Side side) const {
  const std::vector<std::string> labels = labels_of(gait::of_side(gait::SegmentId::left_thigh, side));
  std::vector<Vector<3>> locations;
  for (const std::string& label : labels) locations.push_back(standing_.at(label));
  if (fixes_a_frame(locations)) return solve::skeleton::functional_centre(pelvis_, poses_of(labels));
  const auto& thigh = conventional_[gait::of_side(gait::SegmentId::left_thigh, side)];
  const auto& shank = conventional_[gait::of_side(gait::SegmentId::left_shank, side)];
  const auto outer = standing_.find(of_side(side, "KNE"));
  if (!thigh || !shank || outer == standing_.end()) return std::nullopt;
  const Poses shanks = shank_poses(side);
  const Vector<3> inner = 2 * shank->translation - outer->second;
  std::optional<solve::skeleton::FunctionalCentre> found;
  for (int round = 0; round < kRounds; ++round) {
    const auto axis = knee(side, found ? found->in_parent : thigh->translation);
    const Vector<3> shared = axis ? Vector<3>(axis->point + axis->direction * axis->direction.dot(inner - axis->point)) : inner;
    found = solve::skeleton::functional_centre(pelvis_, poses_of(labels, {{shared, &shanks}}));
    if (!found) break;
  }
  return found;
}

std::optional<solve::skeleton::FunctionalAxis> JointsByMotion::knee(gait::Side side, const Vector<3>& hip) const {
  const Poses thigh = poses_of(labels_of(gait::of_side(gait::SegmentId::left_thigh, side)), {{hip, &pelvis_}});
  return solve::skeleton::functional_axis(thigh, shank_poses(side));
}

std::optional<solve::skeleton::FunctionalAxis> JointsByMotion::elbow(gait::Side side) const {
  const auto& upper_arm = conventional_[gait::of_side(gait::SegmentId::left_upper_arm, side)];
  if (!upper_arm) return std::nullopt;
  // The shoulder goes with the trunk and with its own marker.
  std::vector<std::string> above = labels_of(gait::SegmentId::trunk);
  for (const std::string& label : labels_of(gait::of_side(gait::SegmentId::left_clavicle, side))) above.push_back(label);
  const Poses trunk = poses_of(above);
  const Poses upper = poses_of(labels_of(gait::of_side(gait::SegmentId::left_upper_arm, side)), {{upper_arm->translation, &trunk}});
  std::vector<std::string> forearm = labels_of(gait::of_side(gait::SegmentId::left_forearm, side));
  const std::string elbow = of_side(side, "ELB");
  if (standing_.contains(elbow) && predominantly_observed(elbow)) forearm.push_back(elbow);
  return solve::skeleton::functional_axis(upper, poses_of(forearm));
}

}  // namespace marey::pipeline::bodies
