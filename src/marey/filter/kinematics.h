#pragma once

// Linear motion models that treat every axis alike.
//
// A target's state is its position and the derivatives of it: Order = 2 stops at velocity, Order = 3 at acceleration. A model
// that knows no preferred direction moves this state by F ⊗ I and adds the noise Q ⊗ I, with F and Q of size Order × Order
// and I the D × D identity. So the covariance is kept as D × D blocks, one for each pair of derivatives, and a prediction is a
// few sums of blocks instead of a product of (Order·D)² matrices; a measurement of the position costs one D × D inverse.
// Nothing is approximated: measurement covariances that tie the axes together stay exact.
//
// Models: constant velocity with white acceleration; Singer's acceleration, which fades (R. A. Singer, "Estimating optimal
// tracking filter performance for manned maneuvering targets", IEEE Trans. AES 6, 1970), with constant acceleration as its
// limit; and the planar turn at a known rate (Bar-Shalom, Li, Kirubarajan, "Estimation with Applications to Tracking and
// Navigation", 2001, section 4.2).

#include <array>
#include <cmath>

#include <Eigen/LU>

#include "marey/core/geometry.h"

namespace marey::filter::kinematics {

/// x(t + dt) = (F ⊗ I) x(t) + noise of covariance Q ⊗ I. Orders the state as position, velocity, acceleration.
template <int Order>
struct Model {
  Matrix<Order> F = Matrix<Order>::Identity();
  Matrix<Order> Q = Matrix<Order>::Zero();
};

/// A Gaussian over position and derivatives. Units: px or m, per second, per second².
template <int D, int Order>
struct State {
  static constexpr std::size_t kBlocks = std::size_t{Order} * (Order + 1) / 2;  // by definition

  std::array<Vector<D>, Order> mean;
  std::array<Matrix<D>, kBlocks> blocks;  ///< of the covariance, the upper half: rows above, left to right

  static constexpr std::size_t index(std::size_t i, std::size_t j) { return i * (2 * Order - i - 1) / 2 + j; }

  /// Covariance of derivative i with derivative j, i ≤ j.
  Matrix<D>& cov(std::size_t i, std::size_t j) { return blocks[index(i, j)]; }
  const Matrix<D>& cov(std::size_t i, std::size_t j) const { return blocks[index(i, j)]; }

  /// The same for any i and j.
  Matrix<D> covariance(std::size_t i, std::size_t j) const {
    if (i <= j) return cov(i, j);
    return cov(j, i).transpose();
  }
};

template <int D>
void make_symmetric(Matrix<D>& P) {
  P = (0.5 * (P + P.transpose())).eval();
}

/// At `z`, all derivatives zero, with independent covariances `z_covariance`, sigma₁² I, sigma₂² I, …
template <int D, int Order>
State<D, Order> at_rest(const Vector<D>& z, const Matrix<D>& z_covariance, const std::array<double, Order - 1>& sigmas) {
  State<D, Order> state;
  for (auto& mean : state.mean) mean.setZero();
  for (auto& block : state.blocks) block.setZero();
  state.mean[0] = z;
  state.cov(0, 0) = z_covariance;
  for (std::size_t i = 1; i < Order; ++i) state.cov(i, i) = Matrix<D>::Identity() * (sigmas[i - 1] * sigmas[i - 1]);
  return state;
}

/// No model here knows an absolute place: the first column of F must be (1, 0, …).
template <int D>
void predict(State<D, 2>& state, const Model<2>& model) {
  const double a = model.F(0, 1);
  const double b = model.F(1, 1);
  auto& [pp, pv, vv] = state.blocks;
  pp += a * (pv + pv.transpose()) + (a * a) * vv;
  pv = b * (pv + a * vv);
  vv *= b * b;
  pp.diagonal().array() += model.Q(0, 0);
  pv.diagonal().array() += model.Q(0, 1);
  vv.diagonal().array() += model.Q(1, 1);
  state.mean[0] += a * state.mean[1];
  state.mean[1] *= b;
}

template <int D>
void predict(State<D, 3>& state, const Model<3>& model) {
  const auto& F = model.F;
  const auto& [pp, pv, pa, vv, va, aa] = state.blocks;
  // The columns of P (F ⊗ I)ᵀ that the upper half of (F ⊗ I) times it needs.
  const Matrix<D> av = va.transpose();
  const Matrix<D> p0 = pp + F(0, 1) * pv + F(0, 2) * pa;
  const Matrix<D> p1 = F(1, 1) * pv + F(1, 2) * pa;
  const Matrix<D> p2 = F(2, 1) * pv + F(2, 2) * pa;
  const Matrix<D> v0 = pv.transpose() + F(0, 1) * vv + F(0, 2) * va;
  const Matrix<D> v1 = F(1, 1) * vv + F(1, 2) * va;
  const Matrix<D> v2 = F(2, 1) * vv + F(2, 2) * va;
  const Matrix<D> a0 = pa.transpose() + F(0, 1) * av + F(0, 2) * aa;
  const Matrix<D> a1 = F(1, 1) * av + F(1, 2) * aa;
  const Matrix<D> a2 = F(2, 1) * av + F(2, 2) * aa;
  state.blocks = {p0 + F(0, 1) * v0 + F(0, 2) * a0, p1 + F(0, 1) * v1 + F(0, 2) * a1, p2 + F(0, 1) * v2 + F(0, 2) * a2,
                  F(1, 1) * v1 + F(1, 2) * a1,      F(1, 1) * v2 + F(1, 2) * a2,      F(2, 1) * v2 + F(2, 2) * a2};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j) state.cov(i, j).diagonal().array() += model.Q(static_cast<int>(i), static_cast<int>(j));
    make_symmetric(state.cov(i, i));
  }
  const Vector<D> v = state.mean[1];
  const Vector<D> a = state.mean[2];
  state.mean[0] += F(0, 1) * v + F(0, 2) * a;
  state.mean[1] = F(1, 1) * v + F(1, 2) * a;
  state.mean[2] = F(2, 1) * v + F(2, 2) * a;
}

/// How far off a measurement was: its squared Mahalanobis distance, and the determinant of its covariance S.
struct Innovation {
  double squared = 0;
  double determinant = 1;
};

/// Takes in a measured position.
template <int D, int Order>
Innovation correct(State<D, Order>& state, const Vector<D>& z, const Matrix<D>& R) {
  const Matrix<D> S = state.cov(0, 0) + R;
  const Matrix<D> inverse = S.inverse();
  const Vector<D> innovation = z - state.mean[0];
  const Vector<D> weighted = inverse * innovation;

  std::array<Matrix<D>, Order> row = {};  // covariance of the position with each derivative
  for (std::size_t j = 0; j < Order; ++j) row[j] = state.cov(0, j);
  for (std::size_t i = 0; i < Order; ++i) state.mean[i] += row[i].transpose() * weighted;
  for (std::size_t i = 1; i < Order; ++i) {
    const Matrix<D> gain = row[i].transpose() * inverse;
    for (std::size_t j = i; j < Order; ++j) state.cov(i, j) -= gain * row[j];
    make_symmetric(state.cov(i, i));
  }
  // The position's own row by R S⁻¹ P instead of P − P S⁻¹ P: no digits are lost where P is far larger than R.
  const Matrix<D> keep = R * inverse;
  for (std::size_t j = 0; j < Order; ++j) state.cov(0, j) = keep * row[j];
  make_symmetric(state.cov(0, 0));
  return {innovation.dot(weighted), S.determinant()};
}

/// Constant velocity under white acceleration of spectral density `density` (unit²/s³).
Model<2> constant_velocity(double dt, double density);

/// Acceleration of standard deviation `sigma` (unit/s²) that fades with `time` (s) and is renewed as much. With time → ∞ and
/// 2 sigma²/time kept, this is constant acceleration under white jerk of that density.
Model<3> singer(double dt, double sigma, double time);

/// Constant acceleration under white jerk of spectral density `density` (unit²/s⁵).
Model<3> constant_acceleration(double dt, double density);

/// A turn at `rate` (rad/s) in the plane of velocity and acceleration: the third derivative is −rate² times the first. White
/// noise of spectral density `density` (unit²/s⁵) drives the acceleration, as in `constant_acceleration`.
Model<3> turn(double dt, double rate, double density);

}  // namespace marey::filter::kinematics
