// Limbs that lie nearly the same in two poses: which of them is meant.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include <Eigen/Geometry>

#include "marey/solve/skeleton/pose_solver.h"

namespace marey::solve::skeleton {
namespace {

constexpr double kAtLimitRad = 0.035;  // 2°
constexpr double kOneDirection = 0.2;  // of a range: how lopsided a hinge's is that bends in one direction
constexpr double kBentRad = 0.7;       // 40°: the direction in which a hinge may bend
constexpr double kRotatedRad = 0.4;    // assumed: one σ of an arm's or thigh's turn about itself
constexpr double kBackRad = 0.1;       // assumed: one σ of what an elbow or knee bends backwards
constexpr double kBetter = 1;          // σ² of a marker: less is not a reason to turn a limb about

}  // namespace

void PoseSolver::find_limbs() {
  const Skeleton& skeleton = articulation_.skeleton();
  const SkeletonState rest = articulation_.state_of(skeleton.rest());
  for (std::size_t b = 0; b < articulation_.balls().size(); ++b) {
    const int upper = articulation_.balls()[b].segment;
    const Segment& above = skeleton.segments[static_cast<std::size_t>(upper)];
    for (const Segment& segment : skeleton.segments) {
      if (segment.parent != upper || segment.joint.axes.empty() || segment.joint.axes.size() > 2) continue;
      const JointAxis& hinge = segment.joint.axes.front();
      if (!hinge.is_rotation || !hinge.coordinate) continue;
      const Coordinate& bends = skeleton.coordinates[static_cast<std::size_t>(*hinge.coordinate)];
      if (!bends.free() || !bends.lowest || !bends.highest) continue;
      // What goes as far either way, as a shoulder's girdle, is not an elbow that could be bent backwards.
      if (std::abs(*bends.lowest + *bends.highest) < kOneDirection * (*bends.highest - *bends.lowest)) continue;
      const Vector<3> along = above.joint.joint_from_segment * segment.joint.parent_from_joint.translation;
      if (along.norm() < 1e-3) continue;
      Limb limb{
          .ball = b, .hinge = *hinge.coordinate, .joint_axes = {}, .along = along.normalized(), .rest = rest.balls[b], .near = {}};
      for (const JointAxis& axis : std::span(segment.joint.axes).subspan(1)) {
        if (axis.is_rotation && axis.coordinate && skeleton.coordinates[static_cast<std::size_t>(*axis.coordinate)].free())
          limb.joint_axes.push_back(*axis.coordinate);
      }
      const auto hinge_at = &segment - skeleton.segments.data();
      for (std::size_t s = 0; s < skeleton.segments.size(); ++s) {
        const auto parent = skeleton.segments[s].parent;
        limb.near.push_back(static_cast<int>(s) == upper || above.parent == static_cast<int>(s) || parent == upper ||
                            parent == hinge_at);
      }
      limbs_.push_back(std::move(limb));
    }
  }
}

bool PoseSolver::at_limit(int coordinate) const {
  const Coordinate& hinge = articulation_.skeleton().coordinates[static_cast<std::size_t>(coordinate)];
  const double x = state_.coordinates[static_cast<std::size_t>(coordinate)];
  return x < *hinge.lowest + kAtLimitRad || x > *hinge.highest - kAtLimitRad;
}

/// How unlike a person's a limb is: turned about itself away from rest, and bent in the direction in which it barely bends.
double PoseSolver::oddness(const Limb& limb) const {
  const Coordinate& hinge = articulation_.skeleton().coordinates[static_cast<std::size_t>(limb.hinge)];
  const Eigen::Quaterniond rotated(Matrix<3>(limb.rest.transpose() * state_.balls[limb.ball]));
  const double about = std::remainder(2 * std::atan2(rotated.vec().dot(limb.along), rotated.w()), 2 * std::numbers::pi);
  const double x = state_.coordinates[static_cast<std::size_t>(limb.hinge)];
  const double back = *hinge.lowest + *hinge.highest >= 0 ? std::max(0.0, -x) : std::max(0.0, x);
  return about * about / (kRotatedRad * kRotatedRad) + back * back / (kBackRad * kBackRad);
}

/// Of markers and limits, as they now weigh, and of how odd the limb is.
double PoseSolver::cost_of_pose(const Limb& limb, Detected detected) {
  articulation_.location(state_);
  return gather_markers(detected) + limit_cost(state_) + oddness(limb);
}

/// The state with a limb's upper segment turned about its length and its hinge bent as it may.
std::vector<SkeletonState> PoseSolver::rotated_about(const Limb& limb) const {
  const Coordinate& hinge = articulation_.skeleton().coordinates[static_cast<std::size_t>(limb.hinge)];
  const bool positive = *hinge.lowest + *hinge.highest >= 0;
  const double bent = std::clamp(positive ? kBentRad : -kBentRad, *hinge.lowest, *hinge.highest);
  std::vector<SkeletonState> all;
  for (const double turn : {std::numbers::pi, 0.5 * std::numbers::pi, -0.5 * std::numbers::pi}) {
    SkeletonState from = state_;
    from.balls[limb.ball] = from.balls[limb.ball] * Eigen::AngleAxisd(turn, limb.along).toRotationMatrix();
    from.coordinates[static_cast<std::size_t>(limb.hinge)] = bent;
    all.push_back(from);
    if (limb.joint_axes.empty()) continue;
    for (const int c : limb.joint_axes) from.coordinates[static_cast<std::size_t>(c)] = 0;
    all.push_back(std::move(from));
  }
  for (SkeletonState& state : all) articulation_.skeleton().couple(state.coordinates);
  return all;
}

/// A limb may be turned about itself, its hinge bent backwards as far as the limit lets it: markers on its length barely show it.
/// Tries the other poses of the limbs that are asked, and takes what fits better. Says whether it did.
bool PoseSolver::turn_limbs(Detected detected) {
  bool rotated = false;
  for (const Limb& limb : limbs_) {
    if (!limb.requested) continue;
    SkeletonState best = state_;
    double minimum = cost_of_pose(limb, detected) - kBetter;
    bool better = false;
    for (const SkeletonState& from : rotated_about(limb)) {
      state_ = predicted_ = from;
      minimise(detected, 2 * options_.max_iterations);
      if (const double cost = cost_of_pose(limb, detected); cost < minimum) {
        minimum = cost;
        best = state_;
        better = true;
      }
    }
    state_ = best;
    rotated = rotated || better;
  }
  return rotated;
}

/// What stays at a limit for a while may have come there by a wrong turn.
void PoseSolver::mind_limits(double seconds, Detected detected) {
  bool required = false;
  for (Limb& limb : limbs_) {
    limb.at_limit_s = at_limit(limb.hinge) ? limb.at_limit_s + seconds : 0;
    limb.requested = limb.at_limit_s >= options_.at_limit_s;
    required = required || limb.requested;
  }
  if (!required) return;
  set_weak_prior();
  if (turn_limbs(detected)) pose_.started = true;
  for (Limb& limb : limbs_) {
    if (limb.requested) limb.at_limit_s = 0;
  }
}

std::vector<SkeletonState> PoseSolver::other_poses(std::size_t limb, const SkeletonState& state) {
  state_ = state;
  return rotated_about(limbs_[limb]);
}

double PoseSolver::cost_of(const SkeletonState& state, Detected detected) {
  state_ = state;
  articulation_.location(state_);
  return gather_markers(detected) + limit_cost(state_) + oddness_of_limbs();
}

double PoseSolver::oddness_of_limbs() const {
  double sum = 0;
  for (const Limb& limb : limbs_) sum += oddness(limb);
  return sum;
}

/// While markers were hidden a joint may have come where they pull it into another fold than the one it was in. With the joints
/// near them as they were when all was seen, is it no worse?
void PoseSolver::try_as_it_was(const std::vector<bool>& returned, Detected detected) {
  const auto& segments = articulation_.skeleton().segments;
  const auto near = [&](std::size_t s) {
    for (std::optional<int> at = static_cast<int>(s); at; at = segments[static_cast<std::size_t>(*at)].parent) {
      if (returned[static_cast<std::size_t>(*at)]) return true;
    }
    for (std::size_t other = 0; other < segments.size(); ++other) {
      if (returned[other] && segments[other].parent == static_cast<int>(s)) return true;
    }
    return false;
  };
  const SkeletonState found = state_;
  const double maximum = cost_of(found, detected) + kBetter;
  for (std::size_t s = 1; s < segments.size(); ++s) {
    if (!near(s)) continue;
    for (const JointAxis& axis : segments[s].joint.axes) {
      if (axis.coordinate)
        state_.coordinates[static_cast<std::size_t>(*axis.coordinate)] =
            whole_.coordinates[static_cast<std::size_t>(*axis.coordinate)];
    }
    for (std::size_t b = 0; b < state_.balls.size(); ++b) {
      if (articulation_.balls()[b].segment == static_cast<int>(s)) state_.balls[b] = whole_.balls[b];
    }
  }
  articulation_.skeleton().couple(state_.coordinates);
  predicted_ = state_;
  minimise(detected, 2 * options_.max_iterations);
  if (!(cost_of(SkeletonState(state_), detected) <= maximum)) state_ = found;
}

/// Where markers return, the limbs near them are inspected again: from how they were before, and turned about.
void PoseSolver::mind_returns(Detected detected) {
  std::vector<bool> returned(articulation_.skeleton().segments.size(), false);
  returned_ = false;
  for (std::size_t j = 0; j < detected.size(); ++j) {
    if (!detected[j] || away_s_[j] < options_.away_s || away_s_[j] >= options_.hidden_s) continue;
    returned[static_cast<std::size_t>(articulation_.skeleton().markers[j].segment)] = true;
    returned_ = true;
  }
  if (!returned_) return;
  set_weak_prior();
  const SkeletonState found = state_;
  const double minimum = cost_of(found, detected) - kBetter;
  least_squares_start(detected);
  if (!(cost_of(SkeletonState(state_), detected) < minimum)) state_ = found;
  if (!whole_.coordinates.empty()) try_as_it_was(returned, detected);
  for (Limb& limb : limbs_) {
    limb.requested = false;
    for (std::size_t s = 0; s < returned.size(); ++s) limb.requested = limb.requested || (returned[s] && limb.near[s]);
  }
  turn_limbs(detected);
}

void PoseSolver::remember(double seconds, Detected detected) {
  bool missed = false;
  for (std::size_t j = 0; j < detected.size(); ++j) {
    away_s_[j] = detected[j] ? 0 : std::min(options_.hidden_s, away_s_[j] + seconds);
    missed = missed || (away_s_[j] > 0 && away_s_[j] < options_.hidden_s);
  }
  if (!missed) whole_ = state_;
  const auto& markers = articulation_.skeleton().markers;
  for (std::size_t j = 0; j < detected.size(); ++j) {
    const auto s = static_cast<std::size_t>(markers[j].segment);
    if (!detected[j] || missed_s_[s] > 0) continue;
    found_[j] = articulation_.world_from_segment()[s].inverse() * *detected[j] - markers[j].position;
    if (found_[j].norm() > robust_m_) found_[j].setZero();  // another's label
  }
}

/// Beside hidden markers the others sit where they were found before.
void PoseSolver::shift_markers(double seconds, Detected detected) {
  const auto& markers = articulation_.skeleton().markers;
  near_missed_.assign(missed_s_.size(), false);
  for (std::size_t j = 0; j < detected.size(); ++j) {
    if (detected[j] || away_s_[j] >= options_.hidden_s) continue;
    for (const std::size_t s : near_[static_cast<std::size_t>(markers[j].segment)]) near_missed_[s] = true;
  }
  for (std::size_t s = 0; s < missed_s_.size(); ++s) missed_s_[s] = near_missed_[s] ? missed_s_[s] + seconds : 0;
  for (std::size_t j = 0; j < shifts_.size(); ++j) {
    const double missed = missed_s_[static_cast<std::size_t>(markers[j].segment)];
    shifts_[j] =
        missed > 0 && missed < options_.shift_s ? (1 - missed / options_.shift_s) * found_[j] : Vector<3>(Vector<3>::Zero());
  }
}

}  // namespace marey::solve::skeleton
