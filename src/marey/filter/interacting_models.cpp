#include "marey/filter/interacting_models.h"

#include <algorithm>
#include <limits>

namespace marey {
namespace {

/// Cruising: straight on, and the acceleration is one drawn anew.
kinematics::Model<3> cruise(double dt, double density, double acceleration) {
  const kinematics::Model<2> straight = kinematics::constant_velocity(dt, density);
  kinematics::Model<3> model;
  model.F.setZero();
  model.F.topLeftCorner<2, 2>() = straight.F;
  model.Q.topLeftCorner<2, 2>() = straight.Q;
  model.Q(2, 2) = acceleration * acceleration;
  return model;
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
    : options_(options), probabilities_(options.shares), position_(z), covariance_(R) {
  states_.fill(kinematics::at_rest<D, 3>(z, R, {options.initial_speed, options.acceleration}));
}

template <int D>
void InteractingModels<D>::mix(double dt) {
  const double stay = std::exp(-dt / options_.mode_time);
  const std::array<kinematics::State<D, 3>, kModels> old = states_;
  const std::array<double, kModels> before = probabilities_;

  // Outer products of the differences of the means, for the pairs (0, 1), (0, 2), (1, 2).
  constexpr std::array<std::array<std::size_t, 2>, 3> kPairs = {{{0, 1}, {0, 2}, {1, 2}}};
  std::array<std::array<Vector<D>, 3>, 3> difference;
  for (std::size_t p = 0; p < kPairs.size(); ++p) {
    for (std::size_t i = 0; i < 3; ++i) difference[p][i] = old[kPairs[p][0]].mean[i] - old[kPairs[p][1]].mean[i];
  }

  for (std::size_t j = 0; j < kModels; ++j) {
    std::array<double, kModels> weight;  // chance of having been in i, now in j
    double sum = 0;
    for (std::size_t i = 0; i < kModels; ++i) {
      weight[i] = before[i] * ((i == j ? stay : 0) + (1 - stay) * options_.shares[j]);
      sum += weight[i];
    }
    probabilities_[j] = sum;
    if (!(sum > 0)) continue;  // a model that has no share of the time: left to itself
    for (double& w : weight) w /= sum;

    kinematics::State<D, 3>& mixed = states_[j];
    for (std::size_t i = 0; i < 3; ++i) {
      mixed.mean[i] = weight[0] * old[0].mean[i] + weight[1] * old[1].mean[i] + weight[2] * old[2].mean[i];
    }
    for (std::size_t b = 0; b < mixed.blocks.size(); ++b) {
      mixed.blocks[b] = weight[0] * old[0].blocks[b] + weight[1] * old[1].blocks[b] + weight[2] * old[2].blocks[b];
    }
    for (std::size_t p = 0; p < kPairs.size(); ++p) {
      const double both = weight[kPairs[p][0]] * weight[kPairs[p][1]];
      for (int r = 0; r < 3; ++r) {
        const Vector<D> scaled = both * difference[p][static_cast<std::size_t>(r)];
        for (int c = r; c < 3; ++c) mixed.cov(r, c) += scaled * difference[p][static_cast<std::size_t>(c)].transpose();
      }
    }
  }
}

template <int D>
void InteractingModels<D>::predict(double dt) {
  if (dt == 0) return;
  const double acceleration = options_.acceleration + options_.agility * velocity_.norm();
  mix(dt);
  const kinematics::State<D, 3>& turning = states_[kTurn];
  const double rate = turn_rate<D>(turning.mean[1], turning.cov(1, 1), turning.mean[2], options_.turn_limit);
  const double jerk_density = 2 * acceleration * acceleration / options_.acceleration_time;
  kinematics::predict(states_[kCruise], cruise(dt, options_.cruise_noise * options_.cruise_noise, acceleration));
  kinematics::predict(states_[kPull], kinematics::singer(dt, acceleration, options_.acceleration_time));
  kinematics::predict(states_[kTurn], kinematics::turn(dt, rate, jerk_density));
  summarise();
}

template <int D>
void InteractingModels<D>::correct(const Vector<D>& z, const Matrix<D>& R) {
  std::array<double, kModels> likelihood;
  double largest = -std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < kModels; ++j) {
    likelihood[j] = kinematics::correct(states_[j], z, R);
    if (!std::isfinite(likelihood[j])) likelihood[j] = -std::numeric_limits<double>::max();
    largest = std::max(largest, likelihood[j]);
  }
  double sum = 0;
  for (std::size_t j = 0; j < kModels; ++j) sum += probabilities_[j] *= std::exp(likelihood[j] - largest);
  if (!(sum > 0)) {
    probabilities_ = options_.shares;
    sum = 1;
  }
  for (double& probability : probabilities_) probability /= sum;
  summarise();
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

}  // namespace marey
