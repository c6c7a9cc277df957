// The first pose of a skeleton, of which nothing is known: put where its markers are, then from poses near rest until one fits.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>

#include <Eigen/Geometry>

#include "marey/solve/skeleton/pose_solver.h"

namespace marey::solve::skeleton {
namespace {

constexpr double kColdRobustM = 0.5;  // while nothing is known of the pose
constexpr double kGoodStartM = 0.03;  // RMS with which a start is believed without another
constexpr int kRandomStarts = 12;
constexpr double kWeakPrior = 1;       // 1/rad²
constexpr double kAtLimitRad = 0.035;  // 2°
constexpr double kOneWay = 0.2;        // of a range: how lopsided a hinge's is that bends one way
constexpr double kBentRad = 0.7;       // 40°: the way a hinge may bend
constexpr double kTurnedRad = 0.4;     // assumed: one σ of an arm's or thigh's turn about itself
constexpr double kBackRad = 0.1;       // assumed: one σ of what an elbow or knee bends backwards
constexpr double kBetter = 1;          // σ² of a marker: less is no reason to turn a limb about

/// The same for all runs: a number in [−1, 1).
double next_random(std::uint64_t& state) {
  state = state * 6364136223846793005ULL + 1442695040888963407ULL;
  return static_cast<double>(state >> 11) / static_cast<double>(1ULL << 52) - 1;
}

}  // namespace

/// A rigid motion of the resting skeleton onto what is seen: of the root's own markers, or of all.
std::optional<Rigid3> PoseSolver::root_from(Seen seen, bool root_alone, const SkeletonState& rest) {
  articulation_.place(rest);
  const auto& markers = articulation_.skeleton().markers;
  Eigen::Matrix3Xd model(3, markers.size()), there(3, markers.size());
  Eigen::Index count = 0;
  for (std::size_t j = 0; j < markers.size(); ++j) {
    if (!seen[j] || (root_alone && markers[j].segment != 0)) continue;
    model.col(count) = articulation_.world_from_segment()[static_cast<std::size_t>(markers[j].segment)] * markers[j].position;
    there.col(count++) = *seen[j];
  }
  if (count < 3) return std::nullopt;
  const Eigen::Matrix4d moved = Eigen::umeyama(model.leftCols(count), there.leftCols(count), false);
  return Rigid3{moved.topLeftCorner<3, 3>(), moved.topRightCorner<3, 1>()} * articulation_.world_from_segment().front();
}

std::vector<SkeletonState> PoseSolver::starts(Seen seen) {
  const SkeletonState rest = articulation_.state_of(articulation_.skeleton().rest());
  std::vector<SkeletonState> all;
  for (const bool root_alone : {true, false}) {
    const auto root = root_from(seen, root_alone, rest);
    if (!root) continue;
    if (auto state = articulation_.with_root_at(rest, *root)) all.push_back(std::move(*state));
  }
  if (all.empty()) all.push_back(rest);
  return all;
}

/// From rest, put where the markers are; then from poses near it, until one fits.
void PoseSolver::cold_start(Seen seen) {
  sigma_m_ = options_.marker_sigma_m;
  prior_information_.setConstant(kWeakPrior);
  for (int d = 0; d < articulation_.dofs(); ++d) {
    if (!articulation_.dof()[static_cast<std::size_t>(d)].turns) prior_information_[d] = 1e-4;
  }
  const std::vector<SkeletonState> first = starts(seen);
  SkeletonState best;
  double best_rms = 0;
  std::uint64_t random = 15;
  const auto attempt = [&](const SkeletonState& from) {
    state_ = predicted_ = from;
    for (const double scale : {kColdRobustM, options_.robust_m}) {
      robust_m_ = scale;
      minimise(seen, 2 * options_.max_iterations);
    }
    const double rms = rms_of(seen);
    if (best.coordinates.empty() || rms < best_rms) {
      best = state_;
      best_rms = rms;
    }
  };
  for (const SkeletonState& from : first) attempt(from);
  for (int i = 0; i < kRandomStarts && best_rms > kGoodStartM; ++i) {
    SkeletonState from;
    Eigen::VectorXd off(articulation_.dofs());
    for (int d = 0; d < articulation_.dofs(); ++d)
      off[d] = articulation_.dof()[static_cast<std::size_t>(d)].turns ? 0.8 * next_random(random) : 0;
    articulation_.move(first[static_cast<std::size_t>(i) % first.size()], off, from);
    attempt(from);
  }
  state_ = predicted_ = best;
  rms_of(seen);
  learn_noise(seen);
  turn_limbs(seen, true);
  predicted_ = state_;
}

void PoseSolver::find_limbs() {
  const Skeleton& skeleton = articulation_.skeleton();
  const SkeletonState rest = articulation_.state_of(skeleton.rest());
  for (std::size_t b = 0; b < articulation_.balls().size(); ++b) {
    const int upper = articulation_.balls()[b].segment;
    const Segment& above = skeleton.segments[static_cast<std::size_t>(upper)];
    for (const Segment& segment : skeleton.segments) {
      if (segment.parent != upper || segment.joint.axes.empty() || segment.joint.axes.size() > 2) continue;
      const JointAxis& hinge = segment.joint.axes.front();
      if (!hinge.turns || !hinge.coordinate) continue;
      const Coordinate& bends = skeleton.coordinates[static_cast<std::size_t>(*hinge.coordinate)];
      if (!bends.free() || !bends.lowest || !bends.highest) continue;
      // What goes as far either way, as a shoulder's girdle, is no elbow that could be bent backwards.
      if (std::abs(*bends.lowest + *bends.highest) < kOneWay * (*bends.highest - *bends.lowest)) continue;
      const Vector<3> along = above.joint.joint_from_segment * segment.joint.parent_from_joint.translation;
      if (along.norm() < 1e-3) continue;
      Limb limb{.ball = b, .hinge = *hinge.coordinate, .beside = {}, .along = along.normalized(), .rest = rest.balls[b]};
      for (const JointAxis& axis : std::span(segment.joint.axes).subspan(1)) {
        if (axis.turns && axis.coordinate && skeleton.coordinates[static_cast<std::size_t>(*axis.coordinate)].free())
          limb.beside.push_back(*axis.coordinate);
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

/// How unlike a person's a limb is: turned about itself away from rest, and bent the way that it hardly bends.
double PoseSolver::oddness(const Limb& limb) const {
  const Coordinate& hinge = articulation_.skeleton().coordinates[static_cast<std::size_t>(limb.hinge)];
  const Eigen::Quaterniond turned(Matrix<3>(limb.rest.transpose() * state_.balls[limb.ball]));
  const double about = std::remainder(2 * std::atan2(turned.vec().dot(limb.along), turned.w()), 2 * std::numbers::pi);
  const double x = state_.coordinates[static_cast<std::size_t>(limb.hinge)];
  const double back = *hinge.lowest + *hinge.highest >= 0 ? std::max(0.0, -x) : std::max(0.0, x);
  return about * about / (kTurnedRad * kTurnedRad) + back * back / (kBackRad * kBackRad);
}

/// Of markers and limits, as they now weigh, and of how odd the limb is.
double PoseSolver::cost_of_pose(const Limb& limb, Seen seen) {
  articulation_.place(state_);
  return gather_markers(seen) + limit_cost(state_) + oddness(limb);
}

/// The state with a limb's upper segment turned about its length and its hinge bent the way that it may.
std::vector<SkeletonState> PoseSolver::turned_about(const Limb& limb) const {
  const Coordinate& hinge = articulation_.skeleton().coordinates[static_cast<std::size_t>(limb.hinge)];
  const bool positive = *hinge.lowest + *hinge.highest >= 0;
  const double bent = std::clamp(positive ? kBentRad : -kBentRad, *hinge.lowest, *hinge.highest);
  std::vector<SkeletonState> all;
  for (const double turn : {std::numbers::pi, 0.5 * std::numbers::pi, -0.5 * std::numbers::pi}) {
    SkeletonState from = state_;
    from.balls[limb.ball] = from.balls[limb.ball] * Eigen::AngleAxisd(turn, limb.along).toRotationMatrix();
    from.coordinates[static_cast<std::size_t>(limb.hinge)] = bent;
    all.push_back(from);
    if (limb.beside.empty()) continue;
    for (const int c : limb.beside) from.coordinates[static_cast<std::size_t>(c)] = 0;
    all.push_back(std::move(from));
  }
  for (SkeletonState& state : all) articulation_.skeleton().couple(state.coordinates);
  return all;
}

/// A limb may be turned about itself, its hinge bent backwards as far as the limit lets it: markers on its length hardly tell.
/// Tries the other poses of all limbs, or of those that are at a limit, and takes what fits better. Says whether it did.
bool PoseSolver::turn_limbs(Seen seen, bool all) {
  bool turned = false;
  for (const Limb& limb : limbs_) {
    if (!all && limb.at_limit_s < options_.at_limit_s) continue;
    SkeletonState best = state_;
    double least = cost_of_pose(limb, seen) - kBetter;
    bool better = false;
    for (const SkeletonState& from : turned_about(limb)) {
      state_ = predicted_ = from;
      minimise(seen, 2 * options_.max_iterations);
      if (const double cost = cost_of_pose(limb, seen); cost < least) {
        least = cost;
        best = state_;
        better = true;
      }
    }
    state_ = best;
    turned = turned || better;
  }
  return turned;
}

/// What stays at a limit for a while may have come there by a wrong turn.
void PoseSolver::mind_limits(double seconds, Seen seen) {
  bool wanted = false;
  for (Limb& limb : limbs_) {
    limb.at_limit_s = at_limit(limb.hinge) ? limb.at_limit_s + seconds : 0;
    wanted = wanted || limb.at_limit_s >= options_.at_limit_s;
  }
  if (!wanted) return;
  for (int d = 0; d < articulation_.dofs(); ++d)
    prior_information_[d] = articulation_.dof()[static_cast<std::size_t>(d)].turns ? kWeakPrior : 1e-4;
  if (turn_limbs(seen, false)) pose_.started = true;
  for (Limb& limb : limbs_) {
    if (limb.at_limit_s >= options_.at_limit_s) limb.at_limit_s = 0;
  }
}

}  // namespace marey::solve::skeleton
