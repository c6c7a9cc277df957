#pragma once

// Extended Kalman filter of the coordinated turn (filter/coordinated_turn.h): the state is moved by the turn itself, its
// covariance by the Jacobian at the state. Right while the covariance is small against the curvature of the motion, that is,
// while turn_sigma · dt is well below 1; the unscented filter holds longer.
//
// Source: the extended filter as in Welch, Bishop, "An Introduction to the Kalman Filter", UNC TR 95-041, eq. 2.14-2.18.
// Cost: two products of N × N matrices a step, N = 5 in the plane and 9 in space.

#include "marey/filter/coordinated_turn.h"
#include "marey/filter/gaussian.h"

namespace marey::filter {

template <int D>
class ExtendedKalman;

/// Lengths in px where the filter runs in the image, in m on the ground and in space.
struct ExtendedKalmanOptions {
  TurnNoise noise;
  double initial_speed = 1000;  ///< standard deviation per axis before anything is known, px/s
  double gate_sigmas = 3.5;     ///< border of the search area, in standard deviations of the innovation

  template <int D>
  using Model = ExtendedKalman<D>;

  /// The same filter where one unit of length is `factor` of the new ones.
  ExtendedKalmanOptions scaled(double factor) const {
    return {{noise.acceleration_noise * factor, noise.turn_sigma, noise.turn_time}, initial_speed * factor, gate_sigmas};
  }
};

template <int D>
class ExtendedKalman {
 public:
  using Options = ExtendedKalmanOptions;
  using Motion = CoordinatedTurn<D>;
  static constexpr int dimension = D;

  ExtendedKalman(const Options& options, const Vector<D>& z, const Matrix<D>& R)
      : options_(options), x_(Motion::start(z)), P_(Motion::start_covariance(R, options.initial_speed, options.noise)) {}

  void predict(double dt) {
    typename Motion::Square F;
    x_ = Motion::move(x_, dt, options_.noise, &F);
    P_ = (F * P_ * F.transpose() + Motion::noise(dt, options_.noise)).eval();
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
