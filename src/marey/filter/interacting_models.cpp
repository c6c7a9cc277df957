#include "marey/filter/interacting_models.h"

#include <algorithm>
#include <limits>

namespace marey::filter {
namespace {

using kinematics::State;

/// Moves position and velocity straight on; the acceleration is one drawn again, of this standard deviation.
template <int D>
void predict_straight(State<D, 3>& state, double dt, const Matrix<2>& Q, double acceleration) {
  state.mean[0] += dt * state.mean[1];
  state.mean[2].setZero();
  Matrix<D>& pp = state.cov(0, 0);
  Matrix<D>& pv = state.cov(0, 1);
  Matrix<D>& vv = state.cov(1, 1);
  pp += dt * (pv + pv.transpose()) + (dt * dt) * vv;
  pv += dt * vv;
  pp.diagonal().array() += Q(0, 0);
  pv.diagonal().array() += Q(0, 1);
  vv.diagonal().array() += Q(1, 1);
  state.cov(0, 2).setZero();
  state.cov(1, 2).setZero();
  state.cov(2, 2) = (acceleration * acceleration) * Matrix<D>::Identity();
}

/// A jump of the velocity, of this standard deviation, at any instant of the step alike.
Matrix<2> jump(double dt, double sigma) {
  Matrix<2> Q;
  Q << dt * dt / 3, dt / 2, dt / 2, 1;
  return sigma * sigma * Q;
}

/// The update where the acceleration is tied to nothing.
template <int D>
kinematics::Innovation correct_straight(State<D, 3>& state, const Vector<D>& z, const Matrix<D>& R) {
  State<D, 2> straight;
  straight.mean = {state.mean[0], state.mean[1]};
  straight.blocks = {state.cov(0, 0), state.cov(0, 1), state.cov(1, 1)};
  const kinematics::Innovation innovation = kinematics::correct(straight, z, R);
  state.mean[0] = straight.mean[0];
  state.mean[1] = straight.mean[1];
  state.cov(0, 0) = straight.cov(0, 0);
  state.cov(0, 1) = straight.cov(0, 1);
  state.cov(1, 1) = straight.cov(1, 1);
  return innovation;
}

/// Mean and covariance of position and `Derivatives` − 1 derivatives of a mixture.
template <std::size_t Derivatives, int D, std::size_t Models>
void mix_into(State<D, 3>& mixed, const std::array<State<D, 3>, Models>& states, const std::array<double, Models>& weights) {
  for (std::size_t r = 0; r < Derivatives; ++r) {
    mixed.mean[r] = weights[0] * states[0].mean[r];
    for (std::size_t i = 1; i < Models; ++i) mixed.mean[r] += weights[i] * states[i].mean[r];
    for (std::size_t c = r; c < Derivatives; ++c) {
      mixed.cov(r, c) = weights[0] * states[0].cov(r, c);
      for (std::size_t i = 1; i < Models; ++i) mixed.cov(r, c) += weights[i] * states[i].cov(r, c);
    }
  }
  for (std::size_t i = 0; i < Models; ++i) {
    std::array<Vector<D>, Derivatives> apart;
    for (std::size_t r = 0; r < Derivatives; ++r) apart[r] = states[i].mean[r] - mixed.mean[r];
    for (std::size_t r = 0; r < Derivatives; ++r) {
      const Vector<D> scaled = weights[i] * apart[r];
      for (std::size_t c = r; c < Derivatives; ++c) mixed.cov(r, c) += scaled * apart[c].transpose();
    }
  }
}

}  // namespace

template <int D>
double turn_rate(const Vector<D>& velocity, const Matrix<D>& covariance, const Vector<D>& acceleration, double limit) {
  const double vv = velocity.squaredNorm();
  const double va = velocity.dot(acceleration);
  const double across = std::sqrt(std::max(0.0, vv * acceleration.squaredNorm() - va * va));  // |v × a|
  const double size = vv + covariance.trace();
  return size > 0 ? std::min(limit, across / size) : 0;
}

template <int D>
InteractingModels<D>::InteractingModels(const Options& options, const Vector<D>& z, const Matrix<D>& R)
    : options_(options),
      probabilities_({options.fractions[kStationary], options.fractions[kPull], options.fractions[kTurn], 0}),
      position_(z),
      covariance_(R) {
  states_.fill(kinematics::at_rest<D, 3>(z, R, {options.initial_speed, options.acceleration}));
}

/// `keep` is the chance to stay in a model that lasts, `swerve` that of a swerve.
template <int D>
double InteractingModels<D>::chance_of_change(std::size_t from, std::size_t to, double keep, double swerve) const {
  if (to == kSwerve) return swerve;
  if (from == kSwerve) return (1 - swerve) * options_.fractions[to];
  return (1 - swerve) * ((from == to ? keep : 0) + (1 - keep) * options_.fractions[to]);
}

template <int D>
void InteractingModels<D>::mix(double dt) {
  const double keep = std::exp(-dt / options_.mode_time);
  const double swerve = 1 - std::exp(-dt * options_.swerve_rate);
  const std::array<State, kModels> old = states_;
  const std::array<double, kModels> before = probabilities_;
  for (std::size_t j = 0; j < kModels; ++j) {
    std::array<double, kModels> weights;  // chance of having been in i, now in j
    double sum = 0;
    for (std::size_t i = 0; i < kModels; ++i) sum += weights[i] = before[i] * chance_of_change(i, j, keep, swerve);
    probabilities_[j] = sum;
    if (!(sum > 0)) continue;  // a model that has no share of the time: left to itself
    for (double& weight : weights) weight /= sum;
    if (is_curved(j)) {
      mix_into<3>(states_[j], old, weights);
    } else {
      mix_into<2>(states_[j], old, weights);
    }
  }
}

template <int D>
void InteractingModels<D>::predict(double dt) {
  if (dt == 0) return;
  mix(dt);
  const double swerve_sigma = options_.swerve_speed + options_.swerve_fraction * velocity_.norm();
  move(dt, jump(dt, swerve_sigma));
}

template <int D>
void InteractingModels<D>::predict_unobserved(double dt) {
  if (dt == 0) return;
  move(dt, kinematics::constant_velocity(dt, options_.constant_noise * options_.constant_noise).Q);
}

/// Each model by itself; `swerve` is what the one that swerves adds to position and velocity.
template <int D>
void InteractingModels<D>::move(double dt, const Matrix<2>& swerve) {
  const double acceleration = options_.acceleration + options_.agility * velocity_.norm();
  const State& ptz = states_[kTurn];
  const double rate = turn_rate<D>(ptz.mean[1], ptz.cov(1, 1), ptz.mean[2], options_.turn_limit);
  const double jerk_density = 2 * acceleration * acceleration / options_.acceleration_time;
  const double steady_density = options_.constant_noise * options_.constant_noise;
  predict_straight(states_[kStationary], dt, kinematics::constant_velocity(dt, steady_density).Q, acceleration);
  kinematics::predict(states_[kPull], kinematics::singer(dt, acceleration, options_.acceleration_time));
  kinematics::predict(states_[kTurn], kinematics::turn(dt, rate, jerk_density));
  predict_straight(states_[kSwerve], dt, swerve, acceleration);
  summarise();
}

template <int D>
void InteractingModels<D>::correct(const Vector<D>& z, const Matrix<D>& R) {
  std::array<kinematics::Innovation, kModels> innovations;
  double minimum = std::numeric_limits<double>::max();
  for (std::size_t j = 0; j < kModels; ++j) {
    innovations[j] = is_curved(j) ? kinematics::correct(states_[j], z, R) : correct_straight(states_[j], z, R);
    minimum = std::min(minimum, innovations[j].squared);
  }
  double sum = 0;
  for (std::size_t j = 0; j < kModels; ++j) {
    probabilities_[j] *= std::exp(-0.5 * (innovations[j].squared - minimum)) / std::sqrt(innovations[j].determinant);
    sum += probabilities_[j];
  }
  if (sum > 0 && std::isfinite(sum)) {
    for (double& probability : probabilities_) probability /= sum;
  } else {  // so far from all that doubles cannot decide which is nearest
    probabilities_ = {options_.fractions[kStationary], options_.fractions[kPull], options_.fractions[kTurn], 0};
  }
  summarise();
}

template <int D>
double InteractingModels<D>::log_likelihood(const Vector<D>& z, const Matrix<D>& R) const {
  constexpr double kLogTwoPi = 1.8378770664093453;
  std::array<double, kModels> terms;
  double largest = -std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < kModels; ++j) {
    terms[j] = -std::numeric_limits<double>::infinity();
    if (!(probabilities_[j] > 0)) continue;
    const Matrix<D> S = states_[j].cov(0, 0) + R;
    const Vector<D> residual = z - states_[j].mean[0];
    terms[j] =
        std::log(probabilities_[j]) - 0.5 * (residual.dot(S.inverse() * residual) + std::log(S.determinant()) + D * kLogTwoPi);
    largest = std::max(largest, terms[j]);
  }
  double sum = 0;
  for (const double term : terms) sum += std::exp(term - largest);
  return largest + std::log(sum);
}

template <int D>
double InteractingModels<D>::gate_distance(const Vector<D>& z, const Matrix<D>& R) const {
  double minimum = std::numeric_limits<double>::max();
  for (std::size_t j = 0; j < kModels; ++j) {
    if (probabilities_[j] > 0) minimum = std::min(minimum, mahalanobis<D>(z - states_[j].mean[0], states_[j].cov(0, 0) + R));
  }
  return minimum / options_.gate_sigmas;
}

template <int D>
double InteractingModels<D>::search_reach(double variance) const {
  double widest = 0;
  for (std::size_t j = 0; j < kModels; ++j) {
    if (!(probabilities_[j] > 0)) continue;
    const double sigma = std::sqrt(states_[j].cov(0, 0).trace() + variance);  // at least the ellipse's longest
    widest = std::max(widest, (states_[j].mean[0] - position_).norm() + options_.gate_sigmas * sigma);
  }
  return widest;
}

template <int D>
void InteractingModels<D>::summarise() {
  position_.setZero();
  velocity_.setZero();
  covariance_.setZero();
  for (std::size_t j = 0; j < kModels; ++j) {
    position_ += probabilities_[j] * states_[j].mean[0];
    velocity_ += probabilities_[j] * states_[j].mean[1];
    covariance_ += probabilities_[j] * states_[j].cov(0, 0);
  }
  for (std::size_t j = 0; j < kModels; ++j) {
    const Vector<D> residual = states_[j].mean[0] - position_;
    covariance_ += (probabilities_[j] * residual) * residual.transpose();
  }
}

template double turn_rate<2>(const Vector<2>&, const Matrix<2>&, const Vector<2>&, double);
template double turn_rate<3>(const Vector<3>&, const Matrix<3>&, const Vector<3>&, double);
template class InteractingModels<2>;
template class InteractingModels<3>;

}  // namespace marey::filter
