#include "marey/solve/skeleton/pose_solver.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/stop.h"

namespace marey::solve::skeleton {
namespace {

constexpr double kSmallestSigmaM = 1e-4, kLargestSigmaM = 0.03;
constexpr double kSmallestStep = 1e-6;  // rad, m
constexpr double kWeakest = 1;          // 1/rad²: what is not seen at all deviates by a radian

double geman_mcclure(double squared, double scale) {
  return squared * scale * scale / (scale * scale + squared);
}

}  // namespace

PoseSolver::PoseSolver(const Skeleton& skeleton, const PoseOptions& options)
    : articulation_(skeleton),
      options_(options),
      sigma_m_(options.marker_sigma_m),
      robust_m_(options.robust_m),
      moments_(skeleton.segments.size()) {
  if (skeleton.markers.empty()) throw Error("{}: the skeleton has no markers; without them nothing shows its pose", skeleton.name);
  const int n = articulation_.dofs();
  if (n == 0) throw Error("{}: no joint of the skeleton moves", skeleton.name);
  for (Eigen::VectorXd* v : {&velocity_, &variance_, &prior_information_, &step_, &difference_, &dof_deviation_}) v->setZero(n);
  equations_.information.setZero(n, n);
  equations_.gradient.setZero(n);
  damped_.setZero(n, n);
  covariance_.setZero(n, n);
  dof_observed_.assign(static_cast<std::size_t>(n), false);
  solver_.compute(Eigen::MatrixXd::Identity(n, n));  // its room, taken once
  pose_.residuals.resize(skeleton.markers.size());
  pose_.coordinates = skeleton.rest();
  pose_.deviations.assign(skeleton.coordinates.size(), 0);
  pose_.observed.assign(skeleton.coordinates.size(), false);
  find_limbs();
}

void PoseSolver::start_from(std::vector<double> coordinates) {
  state_ = articulation_.state_of(std::move(coordinates));
  velocity_.setZero();
  variance_.setConstant(1);
  dof_observed_.assign(dof_observed_.size(), true);
  known_ = true;
}

void PoseSolver::predict(double seconds) {
  for (int d = 0; d < articulation_.dofs(); ++d) {
    const bool turns = articulation_.dof()[static_cast<std::size_t>(d)].turns;
    const bool observed = dof_observed_[static_cast<std::size_t>(d)];
    const double off = (turns ? options_.acceleration_rad_s2 : options_.acceleration_m_s2) * seconds * seconds;
    const double hidden = observed ? 0 : options_.hidden_rad_s * seconds;
    if (!observed) velocity_[d] *= std::exp(-seconds / options_.decay_s);
    step_[d] = velocity_[d] * seconds;
    variance_[d] = std::min(10.0, variance_[d] + off * off + hidden * hidden);
    prior_information_[d] = 1 / std::max(1e-12, variance_[d]);
  }
  articulation_.move(state_, step_, predicted_);
}

double PoseSolver::gather_markers(Seen seen) {
  for (Moments& m : moments_) m = {};
  double cost = 0;
  const double information = 1 / (sigma_m_ * sigma_m_);
  const auto& world_from = articulation_.world_from_segment();
  const auto& markers = articulation_.skeleton().markers;
  for (std::size_t j = 0; j < markers.size(); ++j) {
    if (!seen[j]) continue;
    const auto s = static_cast<std::size_t>(markers[j].segment);
    const Vector<3> p = world_from[s] * markers[j].position, off = *seen[j] - p;
    const double squared = off.squaredNorm(), share = robust_m_ * robust_m_ / (robust_m_ * robust_m_ + squared);
    cost += markers[j].weight * information * geman_mcclure(squared, robust_m_);
    const double weight = markers[j].weight * information * share * share;
    Moments& m = moments_[s];
    m.weight += weight;
    m.sum += weight * p;
    m.second += weight * p * p.transpose();
    m.pull += weight * off;
    m.torque += weight * p.cross(off);
  }
  return cost;
}

void PoseSolver::gather(PoseEquations& equations) {
  const Skeleton& skeleton = articulation_.skeleton();
  equations.information.setZero();
  equations.gradient.setZero();
  for (std::size_t s = skeleton.segments.size(); s-- > 0;) {
    const Moments& m = moments_[s];
    for (const Driver& own : articulation_.drivers(s)) {
      equations.gradient[own.dof] += own.turn.dot(m.torque) + own.shift.dot(m.pull);
      // What the markers' weight resists with, where this driver moves them all.
      const Vector<3> force = m.weight * own.shift + own.turn.cross(m.sum);
      const Vector<3> torque = m.sum.cross(own.shift) + m.second.trace() * own.turn - m.second * own.turn;
      for (const Driver& other : articulation_.drivers(s))
        equations.information(own.dof, other.dof) += other.turn.dot(torque) + other.shift.dot(force);
      for (auto above = skeleton.segments[s].parent; above; above = skeleton.segments[static_cast<std::size_t>(*above)].parent) {
        for (const Driver& other : articulation_.drivers(static_cast<std::size_t>(*above))) {
          const double both = other.turn.dot(torque) + other.shift.dot(force);
          equations.information(own.dof, other.dof) += both;
          equations.information(other.dof, own.dof) += both;
        }
      }
    }
    if (const auto parent = skeleton.segments[s].parent) {
      Moments& up = moments_[static_cast<std::size_t>(*parent)];
      up.weight += m.weight;
      up.sum += m.sum;
      up.second += m.second;
      up.pull += m.pull;
      up.torque += m.torque;
    }
  }
}

void PoseSolver::linearise(const SkeletonState& state, Seen seen, PoseEquations& equations) {
  const int n = articulation_.dofs();
  equations.information.resize(n, n);
  equations.gradient.resize(n);
  articulation_.place(state);
  equations.cost = gather_markers(seen);
  gather(equations);
}

double PoseSolver::prior_cost(const SkeletonState& state) {
  articulation_.difference(state, predicted_, difference_);
  return (prior_information_.array() * difference_.array().square()).sum();
}

void PoseSolver::add_prior(const SkeletonState& state) {
  articulation_.difference(state, predicted_, difference_);
  equations_.information.diagonal() += prior_information_;
  equations_.gradient.array() += prior_information_.array() * difference_.array();
}

double PoseSolver::limit_cost(const SkeletonState& state) const {
  double cost = 0;
  for (const Articulation::Dof& dof : articulation_.dof()) {
    if (!dof.coordinate) continue;
    const Coordinate& coordinate = articulation_.skeleton().coordinates[static_cast<std::size_t>(*dof.coordinate)];
    const double x = state.coordinates[static_cast<std::size_t>(*dof.coordinate)];
    const double beyond = std::max({0.0, coordinate.lowest.value_or(x) - x, x - coordinate.highest.value_or(x)});
    cost += beyond * beyond / (options_.limit_rad * options_.limit_rad);
  }
  return cost;
}

void PoseSolver::add_limits(const SkeletonState& state, PoseEquations& equations) const {
  const double information = 1 / (options_.limit_rad * options_.limit_rad);
  for (int d = 0; d < articulation_.dofs(); ++d) {
    const auto& index = articulation_.dof()[static_cast<std::size_t>(d)].coordinate;
    if (!index) continue;
    const Coordinate& coordinate = articulation_.skeleton().coordinates[static_cast<std::size_t>(*index)];
    const double x = state.coordinates[static_cast<std::size_t>(*index)];
    const double to =
        std::clamp(x, coordinate.lowest.value_or(x), std::max(coordinate.lowest.value_or(x), coordinate.highest.value_or(x)));
    if (to == x) continue;
    equations.information(d, d) += information;
    equations.gradient[d] += information * (to - x);
  }
}

double PoseSolver::evaluate(const SkeletonState& state, Seen seen) {
  articulation_.place(state);
  return gather_markers(seen) + prior_cost(state) + limit_cost(state);
}

/// Levenberg–Marquardt from `state_`, with the gain ratio (Madsen, Nielsen, Tingleff 2004, algorithm 3.16). Returns the cost.
double PoseSolver::minimise(Seen seen, int most) {
  double cost = evaluate(state_, seen), damping = 1e-6, growth = 2;
  for (int round = 0; round < most; ++round, ++iterations_) {
    stop_point();
    gather(equations_);
    add_prior(state_);
    add_limits(state_, equations_);
    for (bool accepted = false; !accepted;) {
      damped_ = equations_.information;
      damped_.diagonal() += damping * equations_.information.diagonal();
      solver_.compute(damped_);
      step_ = solver_.solve(equations_.gradient);
      const double size = step_.cwiseAbs().maxCoeff();
      if (!(size < 1e6)) return cost;
      articulation_.move(state_, step_, trial_);
      const double expected = step_.dot(equations_.gradient) + damping * step_.cwiseAbs2().dot(equations_.information.diagonal());
      const double next = evaluate(trial_, seen), gain = (cost - next) / std::max(1e-300, expected);
      if (next <= cost) {
        std::swap(state_, trial_);
        cost = next;
        damping = std::max(1e-12, damping * std::max(1.0 / 3, 1 - std::pow(2 * gain - 1, 3)));
        growth = 2;
        accepted = true;
        if (size < kSmallestStep) return cost;
      } else {
        if (size < kSmallestStep || damping > 1e12) {
          evaluate(state_, seen);
          return cost;
        }
        damping *= growth;
        growth *= 2;
      }
    }
  }
  return cost;
}

double PoseSolver::rms_of(Seen seen) {
  articulation_.place(state_);
  const auto& markers = articulation_.skeleton().markers;
  double sum = 0;
  int count = 0;
  for (std::size_t j = 0; j < markers.size(); ++j) {
    pose_.residuals[j].reset();
    if (!seen[j]) continue;
    const double off =
        (*seen[j] - articulation_.world_from_segment()[static_cast<std::size_t>(markers[j].segment)] * markers[j].position).norm();
    pose_.residuals[j] = off;
    sum += off * off;
    ++count;
  }
  pose_.seen = count;
  pose_.rms_m = count > 0 ? std::sqrt(sum / count) : 0;
  return pose_.rms_m;
}

/// Most markers are far away: that is no wrong label.
bool PoseSolver::lost() const {
  const auto far =
      std::count_if(pose_.residuals.begin(), pose_.residuals.end(), [&](const auto& off) { return off && *off > options_.lost_m; });
  return pose_.seen >= 6 && 2 * far > pose_.seen;
}

/// σ of a marker's coordinate, from what is left over; markers beyond the robust scale do not count.
void PoseSolver::learn_noise(Seen seen) {
  double sum = 0;
  int count = 0;
  for (std::size_t j = 0; j < seen.size(); ++j) {
    if (!pose_.residuals[j] || *pose_.residuals[j] > robust_m_) continue;
    sum += *pose_.residuals[j] * *pose_.residuals[j];
    count += 3;
  }
  const int free = count - articulation_.dofs();
  if (free < 3) return;
  const double now = std::clamp(std::sqrt(sum / free), kSmallestSigmaM, kLargestSigmaM);
  sigma_m_ = pose_.started ? now : std::sqrt(0.9 * sigma_m_ * sigma_m_ + 0.1 * now * now);
  robust_m_ = std::max(options_.robust_m, 6 * sigma_m_);
}

const SolvedPose& PoseSolver::step(double seconds, Seen seen) {
  iterations_ = 0;
  const bool any = std::any_of(seen.begin(), seen.end(), [](const auto& place) { return place.has_value(); });
  pose_.started = !known_ && any;
  since_start_s_ += seconds;
  if (!known_ && !any) {
    state_ = predicted_ = articulation_.state_of(articulation_.skeleton().rest());
  } else if (!known_) {
    cold_start(seen);
    rms_of(seen);
    learn_noise(seen);
    minimise(seen, options_.max_iterations);
  } else {
    last_ = state_;
    predict(std::max(1e-6, seconds));
    state_ = predicted_;
    if (any) minimise(seen, options_.max_iterations);
    rms_of(seen);
    if (lost() && since_start_s_ >= options_.sought_anew_s) {
      pose_.started = true;
      since_start_s_ = 0;
      const SkeletonState before = state_;
      const double rms = pose_.rms_m;
      cold_start(seen);
      if (rms_of(seen) > 0.7 * rms) state_ = before;
    }
    if (any) mind_limits(seconds, seen);
  }
  articulation_.take_angles(state_);
  rms_of(seen);
  learn_noise(seen);
  judge(seen);
  learn_velocity(seconds);
  known_ = known_ || any;
  pose_.coordinates = state_.coordinates;
  pose_.world_from_segment = articulation_.world_from_segment();
  pose_.iterations = iterations_;
  return pose_;
}

/// What this frame's markers alone say of each coordinate.
void PoseSolver::judge(Seen seen) {
  gather_markers(seen);
  gather(equations_);
  const int n = articulation_.dofs();
  equations_.information.diagonal().array() += kWeakest;
  solver_.compute(equations_.information);
  covariance_.setIdentity();
  solver_.solveInPlace(covariance_);
  for (int d = 0; d < n; ++d) {
    const auto at = static_cast<std::size_t>(d);
    dof_deviation_[d] = std::sqrt(std::max(0.0, covariance_(d, d)));
    dof_observed_[at] = dof_deviation_[d] < (articulation_.dof()[at].turns ? options_.not_observed_rad : options_.not_observed_m);
    variance_[d] = 1 / (1 / std::max(1e-12, covariance_(d, d)) + 1 / std::max(1e-12, variance_[d] > 0 ? variance_[d] : 1.0));
    if (const auto& c = articulation_.dof()[at].coordinate) pose_.deviations[static_cast<std::size_t>(*c)] = dof_deviation_[d];
  }
  judge_balls();
  const auto& coordinates = articulation_.skeleton().coordinates;
  for (std::size_t c = 0; c < coordinates.size(); ++c) {
    if (coordinates[c].locked) {
      pose_.observed[c] = true;
      continue;
    }
    const std::size_t from = coordinates[c].coupling ? static_cast<std::size_t>(coordinates[c].coupling->to) : c;
    pose_.deviations[c] = pose_.deviations[from];
    pose_.observed[c] = pose_.deviations[c] < (coordinates[c].turns ? options_.not_observed_rad : options_.not_observed_m);
  }
}

/// Of joints that turn freely: how far each of their angles may be off.
void PoseSolver::judge_balls() {
  for (const Articulation::Ball& ball : articulation_.balls()) {
    // The small turn's part in each angle: turns about the axes as they now stand, seen from the segment.
    Matrix<3> axes, turned = Matrix<3>::Identity();
    for (int i = 2; i >= 0; --i) {
      const auto c = static_cast<std::size_t>(ball.coordinates[static_cast<std::size_t>(i)]);
      axes.col(i) = turned.transpose() * ball.axes.col(i);
      turned = Eigen::AngleAxisd(ball.signs[i] * state_.coordinates[c], ball.axes.col(i)).toRotationMatrix() * turned;
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
  articulation_.difference(last_, state_, difference_);
  for (int d = 0; d < articulation_.dofs(); ++d) {
    if (dof_observed_[static_cast<std::size_t>(d)]) velocity_[d] = difference_[d] / seconds;
  }
}

}  // namespace marey::solve::skeleton
