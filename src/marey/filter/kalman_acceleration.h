#pragma once

// Kalman filter, constant acceleration: the target's acceleration stays but for white noise in its derivative, the jerk.
//
// It follows a long pull (a thrown ball, the start of a sprint) without the lag of constant velocity, and pays with a noisier
// velocity and with a prediction that goes astray in a gap of more than a few frames, growing with the square of the time.
// Source: Bar-Shalom, Li, Kirubarajan, "Estimation with Applications to Tracking and Navigation", 2001, section 6.2.3.
// Cost: about 40 sums of D × D matrices a step and one inverse.

#include "marey/filter/gaussian.h"
#include "marey/filter/kinematics.h"

namespace marey::filter {

template <int D>
class KalmanAcceleration;

/// Lengths in px where the filter runs in the image, in m on the ground and in space.
struct KalmanAccelerationOptions {
  double jerk_noise = 2500;            ///< square root of the spectral density: acceleration strays by this each √second, px/s^2.5
  double initial_speed = 1000;         ///< standard deviation per axis before anything is known, px/s
  double initial_acceleration = 1000;  ///< standard deviation per axis before anything is known, px/s²
  double gate_sigmas = 3.5;            ///< border of the search area, in standard deviations of the innovation

  template <int D>
  using Model = KalmanAcceleration<D>;

  /// The same filter where one unit of length is `factor` of the new ones.
  KalmanAccelerationOptions scaled(double factor) const {
    return {jerk_noise * factor, initial_speed * factor, initial_acceleration * factor, gate_sigmas};
  }
};

template <int D>
class KalmanAcceleration {
 public:
  using Options = KalmanAccelerationOptions;
  static constexpr int dimension = D;

  KalmanAcceleration(const Options& options, const Vector<D>& z, const Matrix<D>& R)
      : options_(options), state_(kinematics::at_rest<D, 3>(z, R, {options.initial_speed, options.initial_acceleration})) {}

  void predict(double dt) {
    kinematics::predict(state_, kinematics::constant_acceleration(dt, options_.jerk_noise * options_.jerk_noise));
  }
  void correct(const Vector<D>& z, const Matrix<D>& R) { kinematics::correct(state_, z, R); }

  Vector<D> position() const { return state_.mean[0]; }
  Vector<D> velocity() const { return state_.mean[1]; }
  Vector<D> acceleration() const { return state_.mean[2]; }
  Matrix<D> covariance() const { return state_.cov(0, 0); }
  Matrix<D> innovation_covariance(const Matrix<D>& R) const { return covariance() + R; }

  /// The search area is the ellipse (the ellipsoid) of `gate_sigmas` standard deviations.
  double gate_distance(const Vector<D>& z, const Matrix<D>& R) const {
    return mahalanobis<D>(z - position(), innovation_covariance(R)) / options_.gate_sigmas;
  }

 private:
  Options options_;
  kinematics::State<D, 3> state_;
};

}  // namespace marey::filter
