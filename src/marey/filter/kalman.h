// Kalman filter, constant velocity: the target moves straight but for white noise in its acceleration; position is measured.
//
// Source: Kalman 1960 as written in Queiroz, Gomide, de Albuquerque Araujo, "Evaluation of Real Time Tracking Methods for an Open
// Source Motion Capture System", eq. 4-8. Deviations: Q follows from the noise density and the step, so that steps may vary
// (Bar-Shalom, Li, Kirubarajan §6.2.2), and eq. 8 is written in Joseph's form, which keeps P symmetric and positive in rounding.
// P is kept as its D × D blocks, because A and H are made of 0, 1 and dt: no product with them is ever formed.
// Cost: about 20 products of D × D matrices a step and one inverse; all of fixed size, nothing is allocated.
#pragma once

#include <cmath>

#include <Eigen/LU>

#include "marey/core/geometry.h"

namespace marey::filter {

template <int D>
class Kalman;

/// Lengths in px where the filter runs in the image, in m on the ground and in space.
struct KalmanOptions {
  double acceleration_noise = 200;  ///< square root of the spectral density: velocity strays by this each √second, px/s^1.5
  double initial_speed = 300;       ///< standard deviation per axis before anything is known, px/s
  double gate_sigmas = 3.5;         ///< border of the search area, in standard deviations of the innovation

  template <int D>
  using Model = Kalman<D>;

  /// The same filter where one unit of length is `factor` of the new ones.
  KalmanOptions scaled(double factor) const { return {acceleration_noise * factor, initial_speed * factor, gate_sigmas}; }
};

template <int D>
class Kalman {
 public:
  using Options = KalmanOptions;
  static constexpr int dimension = D;

  Kalman(const Options& options, const Vector<D>& z, const Matrix<D>& R)
      : position_(z),
        Ppp_(R),
        Pvv_(options.initial_speed * options.initial_speed * Matrix<D>::Identity()),
        acceleration_noise_(options.acceleration_noise),
        noise_density_(options.acceleration_noise * options.acceleration_noise),
        gate_sigmas_(options.gate_sigmas) {}

  /// The noise of the acceleration becomes `factor` times that of the options.
  void scale_noise(double factor) { noise_density_ = std::pow(factor * acceleration_noise_, 2); }

  void predict(double dt) {
    position_ += dt * velocity_;  // eq. 4
    const double q = noise_density_ * dt;
    Ppp_ += dt * (Ppv_ + Ppv_.transpose()) + dt * dt * Pvv_;  // eq. 5
    Ppv_ += dt * Pvv_;
    Ppp_.diagonal().array() += q * dt * dt / 3;
    Ppv_.diagonal().array() += q * dt / 2;
    Pvv_.diagonal().array() += q;
  }

  void correct(const Vector<D>& z, const Matrix<D>& R) {
    const Matrix<D> S_inverse = innovation_covariance(R).inverse();
    const Matrix<D> Kp = Ppp_ * S_inverse;  // eq. 6
    const Matrix<D> Kv = Ppv_.transpose() * S_inverse;
    const Vector<D> residual = z - position_;
    position_ += Kp * residual;  // eq. 7
    velocity_ += Kv * residual;
    const Matrix<D> kept = Matrix<D>::Identity() - Kp;  // eq. 8, Joseph's form
    const Matrix<D> kept_pp = kept * Ppp_;
    const Matrix<D> kept_pv = Ppv_ - Kp * Ppv_;
    Pvv_ += Kv * (Ppp_ + R) * Kv.transpose() - Kv * Ppv_ - (Kv * Ppv_).transpose();
    Pvv_ = (Pvv_ + Pvv_.transpose()).eval() / 2;
    Ppv_ = kept_pv - kept_pp * Kv.transpose() + Kp * R * Kv.transpose();
    Ppp_ = kept_pp * kept.transpose() + Kp * R * Kp.transpose();
    Ppp_ = (Ppp_ + Ppp_.transpose()).eval() / 2;
  }

  Vector<D> position() const { return position_; }
  Vector<D> velocity() const { return velocity_; }
  Matrix<D> covariance() const { return Ppp_; }
  Matrix<D> velocity_covariance() const { return Pvv_; }
  Matrix<D> innovation_covariance(const Matrix<D>& R) const { return Ppp_ + R; }

  /// The search area is the ellipse (the ellipsoid) of `gate_sigmas` standard deviations.
  double gate_distance(const Vector<D>& z, const Matrix<D>& R) const {
    const Vector<D> residual = z - position_;
    return std::sqrt(residual.dot(innovation_covariance(R).inverse() * residual)) / gate_sigmas_;
  }

 private:
  Vector<D> position_;
  Vector<D> velocity_ = Vector<D>::Zero();
  Matrix<D> Ppp_;  // covariance of position; Ppv_ of position with velocity; Pvv_ of velocity
  Matrix<D> Ppv_ = Matrix<D>::Zero();
  Matrix<D> Pvv_;
  double acceleration_noise_;
  double noise_density_;
  double gate_sigmas_;
};

}  // namespace marey::filter
