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
constexpr double kGoodStartM = 0.03;  // RMS with which a start is trusted without another
constexpr int kRandomStarts = 12;

/// The same for all runs: a number in [−1, 1).
double next_random(std::uint64_t& state) {
  state = state * 6364136223846793005ULL + 1442695040888963407ULL;
  return static_cast<double>(state >> 11) / static_cast<double>(1ULL << 52) - 1;
}

}  // namespace

/// A rigid motion of the resting skeleton onto the observations: of the root's own markers, or of all.
std::optional<Rigid3> PoseSolver::root_from(Detected detected, bool root_alone, const SkeletonState& rest) {
  articulation_.location(rest);
  const auto& markers = articulation_.skeleton().markers;
  Eigen::Matrix3Xd model(3, markers.size()), there(3, markers.size());
  Eigen::Index count = 0;
  for (std::size_t j = 0; j < markers.size(); ++j) {
    if (!detected[j] || (root_alone && markers[j].segment != 0)) continue;
    model.col(count) = articulation_.world_from_segment()[static_cast<std::size_t>(markers[j].segment)] * markers[j].position;
    there.col(count++) = *detected[j];
  }
  if (count < 3) return std::nullopt;
  const Eigen::Matrix4d moved = Eigen::umeyama(model.leftCols(count), there.leftCols(count), false);
  return Rigid3{moved.topLeftCorner<3, 3>(), moved.topRightCorner<3, 1>()} * articulation_.world_from_segment().front();
}

std::vector<SkeletonState> PoseSolver::starts(Detected detected) {
  const SkeletonState rest = articulation_.state_of(articulation_.skeleton().rest());
  std::vector<SkeletonState> all;
  for (const bool root_alone : {true, false}) {
    const auto root = root_from(detected, root_alone, rest);
    if (!root) continue;
    if (auto state = articulation_.with_root_at(rest, *root)) all.push_back(std::move(*state));
  }
  if (all.empty()) all.push_back(rest);
  return all;
}

/// From rest, put where the markers are; then from poses near it, until one fits.
void PoseSolver::cold_start(Detected detected) {
  sigma_m_ = options_.marker_sigma_m;
  set_weak_prior();
  std::fill(shifts_.begin(), shifts_.end(), Vector<3>::Zero());
  const std::vector<SkeletonState> first = starts(detected);
  SkeletonState best;
  double best_rms = 0;
  std::uint64_t random = 15;
  const auto attempt = [&](const SkeletonState& from) {
    state_ = predicted_ = from;
    for (const double scale : {kColdRobustM, options_.robust_m}) {
      robust_m_ = scale;
      minimise(detected, 2 * options_.max_iterations);
    }
    const double rms = rms_of(detected);
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
      off[d] = articulation_.dof()[static_cast<std::size_t>(d)].is_rotation ? 0.8 * next_random(random) : 0;
    articulation_.move(first[static_cast<std::size_t>(i) % first.size()], off, from);
    attempt(from);
  }
  state_ = predicted_ = best;
  rms_of(detected);
  learn_noise(detected, 0);
  for (Limb& limb : limbs_) limb.requested = true;
  turn_limbs(detected);
  predicted_ = state_;
}

}  // namespace marey::solve::skeleton
