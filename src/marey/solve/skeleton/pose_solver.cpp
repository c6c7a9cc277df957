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

constexpr double kMinStepSize = 1e-6;       // rad, m; numerical: settled
constexpr double kWeakPrior = 1;            // 1/rad²
constexpr double kWeakPriorOfShift = 1e-4;  // 1/m²
constexpr double kMinS = 1e-6;              // numerical: instants at one time do not divide by 0
constexpr double kPlainM = 1e6;             // a robust scale beyond which none is

double geman_mcclure(double squared, double scale) {
  return squared * scale * scale / (scale * scale + squared);
}

}  // namespace

PoseSolver::PoseSolver(const Skeleton& skeleton, const PoseOptions& options)
    : articulation_(skeleton),
      options_(options),
      sigma_m_(options.marker_sigma_m),
      robust_m_(options.robust_m),
      time_steps_(skeleton.segments.size()) {
  if (skeleton.markers.empty()) throw Error("{}: the skeleton has no markers; without them nothing shows its pose", skeleton.name);
  const int n = articulation_.dofs();
  if (n == 0) throw Error("{}: no joint of the skeleton moves", skeleton.name);
  for (Eigen::VectorXd* v : {&velocity_, &step_, &difference_, &dof_deviation_}) v->setZero(n);
  prior_information_.setZero(n, n);
  equations_.information.setZero(n, n);
  equations_.gradient.setZero(n);
  damped_.setZero(n, n);
  covariance_.setZero(n, n);
  dof_observed_.assign(static_cast<std::size_t>(n), false);
  away_s_.assign(skeleton.markers.size(), options.hidden_s);
  found_.assign(skeleton.markers.size(), Vector<3>::Zero());
  shifts_ = found_;
  missed_s_.assign(skeleton.segments.size(), 0);
  near_.resize(skeleton.segments.size());
  for (std::size_t s = 0; s < skeleton.segments.size(); ++s) {
    near_[s].push_back(s);
    if (const auto parent = skeleton.segments[s].parent) {
      near_[s].push_back(static_cast<std::size_t>(*parent));
      near_[static_cast<std::size_t>(*parent)].push_back(s);
    }
  }
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
  dof_observed_.assign(dof_observed_.size(), true);
  known_ = true;
}

double PoseSolver::scale_of(int dof) const {
  return articulation_.dof()[static_cast<std::size_t>(dof)].is_rotation ? options_.not_observed_rad : options_.not_observed_m;
}

/// In `covariance_` (1 + H)⁻² of a pose: what the markers that are seen leave open of it, all of them counted, for what is far from
/// the prediction is no less seen.
void PoseSolver::find_open(const SkeletonState& state, Detected detected) {
  const int n = articulation_.dofs();
  articulation_.location(state);
  const double robust = std::exchange(robust_m_, kPlainM);
  gather_markers(detected);
  robust_m_ = robust;
  gather(equations_);
  for (int d = 0; d < n; ++d) {
    for (int e = 0; e < n; ++e) damped_(d, e) = scale_of(d) * equations_.information(d, e) * scale_of(e) + (d == e ? 1 : 0);
  }
  solver_.compute(damped_);
  damped_.setIdentity();
  solver_.solveInPlace(damped_);
  covariance_.noalias() = damped_ * damped_;
}

/// Holds what is open at `predicted_`, so strongly.
void PoseSolver::set_prior(Detected detected, double strength) {
  find_open(predicted_, detected);
  for (int d = 0; d < articulation_.dofs(); ++d) {
    for (int e = 0; e < articulation_.dofs(); ++e)
      prior_information_(d, e) = strength * covariance_(d, e) / (scale_of(d) * scale_of(e));
    prior_information_(d, d) += articulation_.dof()[static_cast<std::size_t>(d)].is_rotation ? kWeakPrior : kWeakPriorOfShift;
  }
}

const Eigen::MatrixXd& PoseSolver::openness(const SkeletonState& state, Detected detected) {
  find_open(state, detected);
  return covariance_;
}

SkeletonState PoseSolver::solve_near(const SkeletonState& start, Detected detected) {
  state_ = predicted_ = start;
  set_prior(detected, 1);
  minimise(detected, options_.max_iterations);
  articulation_.take_angles(state_);
  return state_;
}

/// Where the pose is heading.
void PoseSolver::predict(double seconds, Detected detected) {
  const double slower = std::exp(-seconds / options_.decay_s);
  for (int d = 0; d < articulation_.dofs(); ++d) {
    if (!dof_observed_[static_cast<std::size_t>(d)]) velocity_[d] *= slower;
    step_[d] = velocity_[d] * seconds;
  }
  articulation_.move(state_, step_, predicted_);
  shift_markers(seconds, detected);
  set_prior(detected, options_.memory_s / seconds);
}

/// So little that a pose comes from its markers alone.
void PoseSolver::set_weak_prior() {
  prior_information_.setZero();
  for (int d = 0; d < articulation_.dofs(); ++d)
    prior_information_(d, d) = articulation_.dof()[static_cast<std::size_t>(d)].is_rotation ? kWeakPrior : kWeakPriorOfShift;
}

double PoseSolver::gather_markers(Detected detected) {
  for (TimeSteps& m : time_steps_) m = {};
  double cost = 0;
  const double information = 1 / (sigma_m_ * sigma_m_);
  const auto& world_from = articulation_.world_from_segment();
  const auto& markers = articulation_.skeleton().markers;
  for (std::size_t j = 0; j < markers.size(); ++j) {
    if (!detected[j]) continue;
    const auto s = static_cast<std::size_t>(markers[j].segment);
    const Vector<3> p = world_from[s] * (markers[j].position + shifts_[j]), off = *detected[j] - p;
    const double squared = off.squaredNorm(), fraction = robust_m_ * robust_m_ / (robust_m_ * robust_m_ + squared);
    cost += markers[j].weight * information * geman_mcclure(squared, robust_m_);
    const double weight = markers[j].weight * information * fraction * fraction;
    TimeSteps& m = time_steps_[s];
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
    const TimeSteps& m = time_steps_[s];
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
      TimeSteps& up = time_steps_[static_cast<std::size_t>(*parent)];
      up.weight += m.weight;
      up.sum += m.sum;
      up.second += m.second;
      up.pull += m.pull;
      up.torque += m.torque;
    }
  }
}

void PoseSolver::linearise(const SkeletonState& state, Detected detected, PoseEquations& equations) {
  const int n = articulation_.dofs();
  equations.information.resize(n, n);
  equations.gradient.resize(n);
  articulation_.location(state);
  equations.cost = gather_markers(detected);
  gather(equations);
}

double PoseSolver::prior_cost(const SkeletonState& state) {
  articulation_.difference(state, predicted_, difference_);
  return difference_.dot(prior_information_ * difference_);
}

void PoseSolver::add_prior(const SkeletonState& state) {
  articulation_.difference(state, predicted_, difference_);
  equations_.information += prior_information_;
  equations_.gradient.noalias() += prior_information_ * difference_;
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

double PoseSolver::evaluate(const SkeletonState& state, Detected detected) {
  articulation_.location(state);
  return gather_markers(detected) + prior_cost(state) + limit_cost(state);
}

/// Levenberg–Marquardt from `state_`, with the gain ratio (Madsen, Nielsen, Tingleff 2004, algorithm 3.16). Returns the cost.
double PoseSolver::minimise(Detected detected, int maximum) {
  double cost = evaluate(state_, detected), damping = 1e-6, growth = 2;
  for (int round = 0; round < maximum; ++round, ++iterations_) {
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
      const double next = evaluate(trial_, detected), gain = (cost - next) / std::max(1e-300, expected);
      if (next <= cost) {
        std::swap(state_, trial_);
        cost = next;
        damping = std::max(1e-12, damping * std::max(1.0 / 3, 1 - std::pow(2 * gain - 1, 3)));
        growth = 2;
        accepted = true;
        if (size < kMinStepSize) return cost;
      } else {
        if (size < kMinStepSize || damping > 1e12) {
          evaluate(state_, detected);
          return cost;
        }
        damping *= growth;
        growth *= 2;
      }
    }
  }
  return cost;
}

/// From the prediction to the least sum of squares, and on from there.
double PoseSolver::least_squares_start(Detected detected) {
  const double robust = std::exchange(robust_m_, kPlainM);
  state_ = predicted_;
  minimise(detected, options_.max_iterations);
  robust_m_ = robust;
  return minimise(detected, options_.max_iterations);
}

/// From the prediction. Where markers are left so far off that they barely count, a whole segment may have been given up: then the
/// least sum of squares is another start. Returns the cost.
double PoseSolver::solve_frame(Detected detected) {
  const double cost = minimise(detected, options_.max_iterations);
  rms_of(detected);
  if (std::none_of(pose_.residuals.begin(), pose_.residuals.end(), [&](const auto& off) { return off && *off > robust_m_; }))
    return cost;
  const SkeletonState found = state_;
  const double other = least_squares_start(detected);
  if (other < cost) return other;
  state_ = found;
  return cost;
}

const SolvedPose& PoseSolver::step(double seconds, Detected detected) {
  iterations_ = 0;
  const bool any = std::any_of(detected.begin(), detected.end(), [](const auto& location) { return location.has_value(); });
  pose_.started = !known_ && any;
  since_start_s_ += seconds;
  if (!known_ && !any) {
    state_ = predicted_ = articulation_.state_of(articulation_.skeleton().rest());
  } else if (!known_) {
    cold_start(detected);
    rms_of(detected);
    learn_noise(detected, seconds);
    minimise(detected, options_.max_iterations);
  } else {
    last_ = state_;
    predict(std::max(kMinS, seconds), detected);
    state_ = predicted_;
    if (any) solve_frame(detected);
    rms_of(detected);
    if (lost() && since_start_s_ >= options_.reacquire_s) {
      pose_.started = true;
      since_start_s_ = 0;
      const SkeletonState before = state_;
      const double rms = pose_.rms_m;
      cold_start(detected);
      if (rms_of(detected) > 0.7 * rms) state_ = before;
    }
    if (any) mind_limits(seconds, detected);
    if (any) mind_returns(detected);
  }
  articulation_.take_angles(state_);
  rms_of(detected);
  learn_noise(detected, seconds);
  assess(detected);
  learn_velocity(seconds);
  remember(seconds, detected);
  known_ = known_ || any;
  pose_.coordinates = state_.coordinates;
  pose_.world_from_segment = articulation_.world_from_segment();
  pose_.iterations = iterations_;
  return pose_;
}

}  // namespace marey::solve::skeleton
