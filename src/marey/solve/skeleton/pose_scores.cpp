// What a solved pose is worth: how far its markers are, what they say of each coordinate, and how it moves.
#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "marey/solve/skeleton/pose_solver.h"

namespace marey::solve::skeleton {
namespace {

constexpr double kMinSigmaM = 1e-4, kMaxSigmaM = 0.03;
constexpr double kRobust = 10;     // σ: a misfit of the model is nothing to be discarded, a marker of another name is
constexpr double kStrangeM = 0.1;  // a marker so far off is not this one
constexpr double kWeakest = 1;     // 1/rad²: what is not seen at all deviates by a radian

}  // namespace

double PoseSolver::rms_of(Detected detected) {
  articulation_.location(state_);
  const auto& markers = articulation_.skeleton().markers;
  double sum = 0;
  int count = 0;
  for (std::size_t j = 0; j < markers.size(); ++j) {
    pose_.residuals[j].reset();
    if (!detected[j]) continue;
    const double off =
        (*detected[j] - articulation_.world_from_segment()[static_cast<std::size_t>(markers[j].segment)] * markers[j].position)
            .norm();
    pose_.residuals[j] = off;
    sum += off * off;
    ++count;
  }
  pose_.detected = count;
  pose_.rms_m = count > 0 ? std::sqrt(sum / count) : 0;
  return pose_.rms_m;
}

/// Most markers are far away: that is not a wrong label.
bool PoseSolver::lost() const {
  const auto far =
      std::count_if(pose_.residuals.begin(), pose_.residuals.end(), [&](const auto& off) { return off && *off > options_.lost_m; });
  return pose_.detected >= 6 && 2 * far > pose_.detected;
}

/// σ of a marker's coordinate, from the rest over; markers beyond the robust scale do not count.
void PoseSolver::learn_noise(Detected detected, double seconds) {
  double sum = 0;
  int count = 0;
  for (std::size_t j = 0; j < detected.size(); ++j) {
    if (!pose_.residuals[j] || *pose_.residuals[j] > robust_m_) continue;
    sum += *pose_.residuals[j] * *pose_.residuals[j];
    count += 3;
  }
  const int free = count - articulation_.dofs();
  if (free < 3) return;
  const double now = std::clamp(std::sqrt(sum / free), kMinSigmaM, kMaxSigmaM);
  const double fraction = pose_.started ? 1 : 1 - std::exp(-seconds / options_.noise_s);
  sigma_m_ = std::sqrt((1 - fraction) * sigma_m_ * sigma_m_ + fraction * now * now);
  robust_m_ = std::max(options_.robust_m, kRobust * sigma_m_);
}

void PoseSolver::learn_noise_of(std::span<const std::vector<double>> rows,
                                std::span<const std::vector<std::optional<Vector<3>>>> frames) {
  double sum = 0, count = 0;
  for (std::size_t f = 0; f < rows.size(); ++f) {
    SkeletonState there = articulation_.state_of(rows[f]);
    std::swap(state_, there);
    rms_of(frames[f]);
    std::swap(state_, there);
    double own = 0;
    for (const auto& off : pose_.residuals) {
      if (!off || *off > kStrangeM) continue;
      sum += *off * *off;
      own += 3;
    }
    count += std::max(0.0, own - articulation_.dofs());
  }
  if (count < 3) return;
  sigma_m_ = std::clamp(std::sqrt(sum / count), kMinSigmaM, kMaxSigmaM);
  robust_m_ = std::max(options_.robust_m, kRobust * sigma_m_);
}

const SolvedPose& PoseSolver::inspect_at(std::vector<double> coordinates, Detected detected) {
  SkeletonState there = articulation_.state_of(std::move(coordinates));
  std::swap(state_, there);
  rms_of(detected);
  assess(detected);
  pose_.started = false;
  pose_.coordinates = state_.coordinates;
  pose_.world_from_segment = articulation_.world_from_segment();
  std::swap(state_, there);
  return pose_;
}

/// What this frame's markers alone say of each coordinate.
void PoseSolver::assess(Detected detected) {
  gather_markers(detected);
  gather(equations_);
  const int n = articulation_.dofs();
  equations_.information.diagonal().array() += kWeakest;
  solver_.compute(equations_.information);
  covariance_.setIdentity();
  solver_.solveInPlace(covariance_);
  for (int d = 0; d < n; ++d) {
    const auto at = static_cast<std::size_t>(d);
    dof_deviation_[d] = std::sqrt(std::max(0.0, covariance_(d, d)));
    dof_observed_[at] = dof_deviation_[d] < scale_of(d);
    if (const auto& c = articulation_.dof()[at].coordinate) pose_.deviations[static_cast<std::size_t>(*c)] = dof_deviation_[d];
  }
  evaluate_balls();
  const auto& coordinates = articulation_.skeleton().coordinates;
  for (std::size_t c = 0; c < coordinates.size(); ++c) {
    if (coordinates[c].locked) {
      pose_.observed[c] = true;
      continue;
    }
    const std::size_t from = coordinates[c].coupling ? static_cast<std::size_t>(coordinates[c].coupling->to) : c;
    pose_.deviations[c] = pose_.deviations[from];
    pose_.observed[c] = pose_.deviations[c] < (coordinates[c].is_rotation ? options_.not_observed_rad : options_.not_observed_m);
  }
}

/// Of joints that turn freely: how far each of their angles may be off.
void PoseSolver::evaluate_balls() {
  for (const Articulation::Ball& ball : articulation_.balls()) {
    // The small turn's part in each angle: turns about the axes as they now stand, seen from the segment.
    Matrix<3> axes, rotated = Matrix<3>::Identity();
    for (int i = 2; i >= 0; --i) {
      const auto c = static_cast<std::size_t>(ball.coordinates[static_cast<std::size_t>(i)]);
      axes.col(i) = rotated.transpose() * ball.axes.col(i);
      rotated = Eigen::AngleAxisd(ball.signs[i] * state_.coordinates[c], ball.axes.col(i)).toRotationMatrix() * rotated;
    }
    Matrix<3> spread = Matrix<3>::Identity();
    if (std::abs(axes.determinant()) > 1e-6) {
      const Matrix<3> back = axes.inverse();
      spread = back * covariance_.block<3, 3>(ball.first_dof, ball.first_dof) * back.transpose();
    }
    for (int i = 0; i < 3; ++i)
      pose_.deviations[static_cast<std::size_t>(ball.coordinates[static_cast<std::size_t>(i)])] =
          std::sqrt(std::max(0.0, spread(i, i)));
  }
}

void PoseSolver::learn_velocity(double seconds) {
  if (!known_ || seconds <= 0 || pose_.started) {
    velocity_.setZero();
    return;
  }
  if (returned_) return;  // what is corrected is not a motion
  const double fraction = 1 - std::exp(-seconds / options_.velocity_s);
  articulation_.difference(last_, state_, difference_);
  for (int d = 0; d < articulation_.dofs(); ++d) {
    if (dof_observed_[static_cast<std::size_t>(d)]) velocity_[d] += fraction * (difference_[d] / seconds - velocity_[d]);
  }
}

}  // namespace marey::solve::skeleton
