#pragma once

// Kalman filter of Queiroz, Gomide, de Albuquerque Araujo, "Evaluation of Real Time Tracking Methods for an Open Source Motion
// Capture System", eq. 4-8, with the values of their program: a step of one frame, a fixed measurement noise, noise in the
// velocity alone that grows with the speed, and a circle as search area that grows with the velocity's uncertainty.
//
// It is kept to compare with. What the original leaves open: |v| of an axis is that axis's own predicted velocity; a step of
// n frames (a gap, or an uneven clock) moves n times as far and adds n times the noise; in space the third axis has the mean
// variance of the two others and no correlation with them. The covariance of a measurement is not used: R is the filter's own.
// Cost: two products of 2D × 2D matrices a step.

#include <cmath>

#include "marey/filter/gaussian.h"

namespace marey::filter {

template <int D>
class KalmanPaper;

/// Lengths in px where the filter runs in the image, in m on the ground and in space; velocities per frame.
struct KalmanPaperOptions {
  double frame_rate = 30;                  ///< Hz; what one frame lasts
  double r_xx = 0.2845;                    ///< of R, px²
  double r_xy = 0.0045;                    ///< of R, px²
  double r_yy = 0.0455;                    ///< of R, px²
  double initial_velocity_variance = 100;  ///< per axis, (px/frame)²
  double noise_per_speed = 0.013;          ///< variance of the velocity gained each frame, for each px/frame of speed
  double min_noise = 0.06;                 ///< the same at rest, (px/frame)²
  double search_factor = 100;              ///< search radius over the mean standard deviation of the predicted velocity

  template <int D>
  using Model = KalmanPaper<D>;

  /// The same filter where one unit of length is `factor` of the new ones.
  KalmanPaperOptions scaled(double factor) const {
    const double squared = factor * factor;
    return {frame_rate,
            r_xx * squared,
            r_xy * squared,
            r_yy * squared,
            initial_velocity_variance * squared,
            noise_per_speed * factor,
            min_noise * squared,
            search_factor};
  }
};

template <int D>
class KalmanPaper {
 public:
  using Options = KalmanPaperOptions;
  static constexpr int dimension = D;

  KalmanPaper(const Options& options, const Vector<D>& z, const Matrix<D>& /*R*/) : options_(options) {
    x_.template head<D>() = z;
    P_.diagonal().template tail<D>().setConstant(options.initial_velocity_variance);
    R_.setZero();
    R_.diagonal().setConstant(0.5 * (options.r_xx + options.r_yy));
    R_.template topLeftCorner<2, 2>() << options.r_xx, options.r_xy, options.r_xy, options.r_yy;
  }

  void predict(double dt) {
    const double frames = dt * options_.frame_rate;
    x_.template head<D>() += frames * x_.template tail<D>();           // eq. 4
    P_.template topRows<D>() += frames * P_.template bottomRows<D>();  // eq. 5
    P_.template leftCols<D>() += (frames * P_.template rightCols<D>()).eval();
    for (int axis = 0; axis < D; ++axis) {
      const double noise = options_.noise_per_speed * std::abs(x_[D + axis]) + options_.min_noise;
      P_(D + axis, D + axis) += frames * noise;
    }
  }

  void correct(const Vector<D>& z, const Matrix<D>& /*R*/) { correct_position<D, 2 * D>(x_, P_, z, R_); }  // eq. 6-8

  Vector<D> position() const { return x_.template head<D>(); }
  Vector<D> velocity() const { return options_.frame_rate * x_.template tail<D>(); }
  Matrix<D> covariance() const { return P_.template topLeftCorner<D, D>(); }
  Matrix<D> innovation_covariance(const Matrix<D>& /*R*/) const { return covariance() + R_; }

  double search_radius() const { return options_.search_factor * P_.diagonal().template tail<D>().cwiseMax(0).cwiseSqrt().mean(); }

  /// The search area is a circle (a ball) of `search_radius()`.
  double gate_distance(const Vector<D>& z, const Matrix<D>& /*R*/) const { return (z - position()).norm() / search_radius(); }

 private:
  Options options_;
  Vector<2 * D> x_ = Vector<2 * D>::Zero();  // position, then velocity per frame
  Matrix<2 * D> P_ = Matrix<2 * D>::Zero();
  Matrix<D> R_;
};

}  // namespace marey::filter
