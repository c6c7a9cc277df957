#include "marey/filter/condensation.h"

#include <bit>

namespace marey::filter {
namespace {

/// Different targets get different streams from one seed: the first measurement is hashed into it.
template <int D>
std::uint64_t own_seed(std::uint64_t seed, const Vector<D>& z) {
  for (int axis = 0; axis < D; ++axis) {
    seed ^= std::bit_cast<std::uint64_t>(z[axis]);
    seed = RandomStream(seed).bits();
  }
  return seed;
}

}  // namespace

template <int D>
Condensation<D>::Condensation(const Options& options, const Vector<D>& z, const Matrix<D>& R)
    : options_(options), random_(own_seed<D>(options.seed, z)), position_(z), covariance_(R), last_estimate_(z) {
  const int n = options_.particles = std::max(1, options.particles);
  locations_ = Cloud::Zero(D, n);
  diffuse(locations_, options_.initial_spread);
  locations_.colwise() -= locations_.rowwise().mean().eval();
  locations_.colwise() += z;
  if (options_.with_velocity) {
    velocities_ = Cloud::Zero(D, n);
    diffuse(velocities_, options_.initial_speed);
    velocities_.colwise() -= velocities_.rowwise().mean().eval();
  }
  selected_ = locations_;
  weights_ = Eigen::RowVectorXd::Constant(n, 1.0 / n);
  chosen_.resize(static_cast<std::size_t>(n));
  summarise();
  position_ = z;
  velocity_.setZero();
}

template <int D>
void Condensation<D>::select() {
  if (even_) return;
  const auto n = static_cast<std::size_t>(options_.particles);
  const double step = 1.0 / static_cast<double>(n);
  double required = random_.uniform() * step;
  double reached = weights_[0];
  int source = 0;
  for (std::size_t i = 0; i < n; ++i, required += step) {
    while (reached < required && source + 1 < options_.particles) reached += weights_[++source];
    chosen_[i] = source;
  }
  const auto gather = [&](Cloud& cloud) {
    for (int axis = 0; axis < D; ++axis) {
      for (std::size_t i = 0; i < n; ++i) selected_(axis, static_cast<int>(i)) = cloud(axis, chosen_[i]);
    }
    cloud.swap(selected_);
  };
  gather(locations_);
  if (options_.with_velocity) gather(velocities_);
  weights_.setConstant(step);
  even_ = true;
}

template <int D>
void Condensation<D>::diffuse(Cloud& cloud, double sigma) {
  if (!(sigma > 0)) return;
  double* const numbers = cloud.data();
  const auto count = cloud.size();
  for (Eigen::Index i = 0; i + 1 < count; i += 2) {
    const auto [first, second] = random_.normal_pair();
    numbers[i] += sigma * first;
    numbers[i + 1] += sigma * second;
  }
  if (count % 2 != 0) numbers[count - 1] += sigma * random_.normal_pair().first;
}

template <int D>
void Condensation<D>::predict(double dt) {
  if (dt == 0) return;
  select();
  since_correction_ += dt;
  const double root = std::sqrt(dt);
  if (options_.with_velocity) {
    // The mean of the velocity before and after its kick: what white acceleration does to the position, to first order.
    locations_ += (0.5 * dt) * velocities_;
    diffuse(velocities_, options_.velocity_diffusion * root);
    locations_ += (0.5 * dt) * velocities_;
  }
  diffuse(locations_, options_.diffusion * root);
  summarise();
}

template <int D>
void Condensation<D>::correct(const Vector<D>& z, const Matrix<D>& R) {
  const Matrix<D> wide = R + options_.likelihood_sigma * options_.likelihood_sigma * Matrix<D>::Identity();
  const Matrix<D> inverse = wide.inverse();
  for (int i = 0; i < options_.particles; ++i) {
    const Vector<D> residual = z - locations_.col(i);
    weights_[i] = -0.5 * residual.dot(inverse * residual) + (even_ ? 0 : std::log(weights_[i]));
  }
  const double largest = weights_.maxCoeff();
  if (!std::isfinite(largest)) return;  // beyond what doubles can square: nothing to learn from it
  weights_ = (weights_.array() - largest).exp();
  weights_ /= weights_.sum();
  even_ = false;
  summarise();
  if (!options_.with_velocity && since_correction_ > 0) velocity_ = (position_ - last_estimate_) / since_correction_;
  last_estimate_ = position_;
  since_correction_ = 0;
}

template <int D>
void Condensation<D>::summarise() {
  position_ = locations_ * weights_.transpose();
  covariance_.setZero();
  for (int i = 0; i < options_.particles; ++i) {
    const Vector<D> residual = locations_.col(i) - position_;
    covariance_ += weights_[i] * residual * residual.transpose();
  }
  if (options_.with_velocity) velocity_ = velocities_ * weights_.transpose();
}

template <int D>
double Condensation<D>::search_radius() const {
  const double spread = std::sqrt(covariance_.trace() / D);
  return options_.search_spreads * std::hypot(spread, options_.likelihood_sigma);
}

template class Condensation<2>;
template class Condensation<3>;

}  // namespace marey::filter
