#pragma once

// Unscented Kalman filter of the coordinated turn (filter/coordinated_turn.h): instead of a Jacobian, 2N + 1 points that have
// the state's mean and covariance are each moved by the turn, and their mean and covariance are the prediction.
//
// Source: Julier, Uhlmann, "A new extension of the Kalman filter to nonlinear systems", Proc. SPIE 3068, 1997: points at
// ± the columns of Cholesky's root of (N + kappa) P, weights kappa/(N + kappa) and 1/(2 (N + kappa)). They propose kappa = 3 − N,
// which is negative here (N = 5 in the plane, 9 in space) and can make a covariance that is not one; with the default of 0 no
// weight is negative and P stays positive. A measurement of the position is linear, so the update is Kalman's own, which the points
// drawn again after the noise was added would give as well.
// Cost: 2N + 1 moves of the state, a root and 2N + 1 outer products a step.

#include "marey/filter/coordinated_turn.h"
#include "marey/filter/gaussian.h"

namespace marey::filter {

template <int D>
class UnscentedKalman;

/// Lengths in px where the filter runs in the image, in m on the ground and in space.
struct UnscentedKalmanOptions {
  TurnNoise noise;
  double kappa = 0;             ///< weight of the middle point, kappa/(N + kappa); ≥ 0
  double initial_speed = 1000;  ///< standard deviation per axis before anything is known, px/s
  double gate_sigmas = 3.5;     ///< border of the search area, in standard deviations of the innovation

  template <int D>
  using Model = UnscentedKalman<D>;

  /// The same filter where one unit of length is `factor` of the new ones.
  UnscentedKalmanOptions scaled(double factor) const {
    return {{noise.acceleration_noise * factor, noise.turn_sigma, noise.turn_time}, kappa, initial_speed * factor, gate_sigmas};
  }
};

/// L with L Lᵀ = P, lower triangular. Where P is only just positive, pivots that rounding made negative count as 0.
template <int N>
Matrix<N> cholesky_root(const Matrix<N>& P) {
  Matrix<N> L = Matrix<N>::Zero();
  for (int j = 0; j < N; ++j) {
    const double pivot = P(j, j) - L.row(j).head(j).squaredNorm();
    if (!(pivot > 0)) continue;
    L(j, j) = std::sqrt(pivot);
    for (int i = j + 1; i < N; ++i) L(i, j) = (P(i, j) - L.row(i).head(j).dot(L.row(j).head(j))) / L(j, j);
  }
  return L;
}

template <int D>
class UnscentedKalman {
 public:
  using Options = UnscentedKalmanOptions;
  using Motion = CoordinatedTurn<D>;
  static constexpr int dimension = D;

  UnscentedKalman(const Options& options, const Vector<D>& z, const Matrix<D>& R)
      : options_(options), x_(Motion::start(z)), P_(Motion::start_covariance(R, options.initial_speed, options.noise)) {}

  void predict(double dt) {
    if (dt == 0) return;
    constexpr int N = Motion::kSize;
    const double scale = N + options_.kappa;
    const Matrix<N> root = std::sqrt(scale) * cholesky_root<N>(P_);
    Eigen::Matrix<double, N, 2 * N + 1> points;
    points.col(0) = Motion::move(x_, dt, options_.noise);
    for (int k = 0; k < N; ++k) {
      points.col(1 + k) = Motion::move(x_ + root.col(k), dt, options_.noise);
      points.col(1 + N + k) = Motion::move(x_ - root.col(k), dt, options_.noise);
    }
    const double middle = options_.kappa / scale;
    const double outer = 0.5 / scale;
    x_ = middle * points.col(0) + outer * points.template rightCols<2 * N>().rowwise().sum();
    points.colwise() -= x_;
    P_ = outer * points.template rightCols<2 * N>() * points.template rightCols<2 * N>().transpose();
    P_ += middle * points.col(0) * points.col(0).transpose();
    P_ += Motion::noise(dt, options_.noise);
  }

  void correct(const Vector<D>& z, const Matrix<D>& R) { correct_position<D, Motion::kSize>(x_, P_, z, R); }

  Vector<D> position() const { return x_.template head<D>(); }
  Vector<D> velocity() const { return x_.template segment<D>(D); }
  /// rad/s; in the plane one number, in space a vector along the axis of the turn.
  Vector<Motion::kTurn> turn() const { return x_.template tail<Motion::kTurn>(); }
  Matrix<D> covariance() const { return P_.template topLeftCorner<D, D>(); }
  Matrix<D> innovation_covariance(const Matrix<D>& R) const { return covariance() + R; }

  /// The search area is the ellipse (the ellipsoid) of `gate_sigmas` standard deviations.
  double gate_distance(const Vector<D>& z, const Matrix<D>& R) const {
    return mahalanobis<D>(z - position(), innovation_covariance(R)) / options_.gate_sigmas;
  }

 private:
  Options options_;
  typename Motion::State x_;
  typename Motion::Square P_;
};

}  // namespace marey::filter
