// Alpha-beta filter: the target is taken to move straight at a steady speed between two measurements; the residual is shared
// between position and velocity by two constants. The cheapest filter there is, and one without a memory of its own certainty.
//
// Source: Queiroz, Gomide, de Albuquerque Araujo, "Evaluation of Real Time Tracking Methods for an Open Source Motion Capture
// System", eq. 1-3. Deviations: the step Δt of eq. 3 is the time since the last correction, so that frames may be missed or
// come unevenly; and a covariance is reported, the steady-state one of the filter for white measurement noise (Bar-Shalom, Li,
// Kirubarajan, "Estimation with Applications to Tracking and Navigation", §6.5), so that it can be gated like the others.
// Cost: 4 D multiplications a step.
#pragma once

#include "marey/core/geometry.h"

namespace marey::filter {

template <int D>
class AlphaBeta;

/// Lengths in px where the filter runs in the image, in m on the ground and in space.
struct AlphaBetaOptions {
  double alpha = 1.0;         ///< share of the residual that position takes, in (0, 1]
  double beta = 0.8;          ///< share that velocity takes, in (0, 4 − 2 alpha)
  double search_radius = 40;  ///< 5 % of the diagonal of 640 × 480, px or m

  template <int D>
  using Model = AlphaBeta<D>;

  /// The same filter where one unit of length is `factor` of the new ones.
  AlphaBetaOptions scaled(double factor) const { return {alpha, beta, search_radius * factor}; }
};

template <int D>
class AlphaBeta {
 public:
  using Options = AlphaBetaOptions;
  static constexpr int dimension = D;

  AlphaBeta(const Options& options, const Vector<D>& z, const Matrix<D>& R) : options_(options), position_(z), R_(R) {}

  void predict(double dt) {
    position_ += dt * velocity_;
    since_correction_ += dt;
  }

  void correct(const Vector<D>& z, const Matrix<D>& R) {
    const Vector<D> residual = z - position_;                                                // eq. 1
    position_ += options_.alpha * residual;                                                  // eq. 2
    if (since_correction_ > 0) velocity_ += (options_.beta / since_correction_) * residual;  // eq. 3
    if (since_correction_ > 0) last_step_ = since_correction_;
    since_correction_ = 0;
    R_ = R;
  }

  Vector<D> position() const { return position_; }
  Vector<D> velocity() const { return velocity_; }

  /// Steady-state variance of the smoothed position, grown over the time since the last correction.
  Matrix<D> covariance() const {
    const double a = options_.alpha;
    const double b = options_.beta;
    const double steps = last_step_ > 0 ? since_correction_ / last_step_ : 0;
    const double position = 2 * a * a + b * (2 - 3 * a);
    const double both = b * (2 * a - b);
    const double velocity = 2 * b * b;
    return R_ * ((position + 2 * steps * both + steps * steps * velocity) / (a * (4 - b - 2 * a)));
  }

  Matrix<D> innovation_covariance(const Matrix<D>& R) const { return covariance() + R; }

  /// The search area is a circle (a ball) of fixed radius.
  double gate_distance(const Vector<D>& z, const Matrix<D>& /*R*/) const { return (z - position_).norm() / options_.search_radius; }

 private:
  Options options_;
  Vector<D> position_;
  Vector<D> velocity_ = Vector<D>::Zero();
  Matrix<D> R_;
  double since_correction_ = 0;  // s
  double last_step_ = 0;         // s, between the last two corrections; 0 before the second
};

}  // namespace marey::filter
