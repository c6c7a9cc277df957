#pragma once

// Alpha-beta filter with a search area that grows with the target's speed: what the conclusion of Queiroz, Gomide, de
// Albuquerque Araujo, "Evaluation of Real Time Tracking Methods for an Open Source Motion Capture System" proposes without
// saying how. Here the radius is a least radius and, on top of it, a share of the path that the target is expected to go since
// it was last seen: with a share of 2, a target that turns straight back between two frames is still found. Before a second
// measurement the speed is not known and the radius is the fixed one of the original.

#include "marey/filter/alpha_beta.h"

namespace marey::filter {

template <int D>
class AlphaBetaVariable;

/// Lengths in px where the filter runs in the image, in m on the ground and in space.
struct AlphaBetaVariableOptions {
  double alpha = 1.0;             ///< share of the residual that position takes, in (0, 1]
  double beta = 0.8;              ///< share that velocity takes, in (0, 4 − 2 alpha)
  double first_radius = 40;       ///< before the speed is known, px or m
  double min_radius = 15;         ///< of a target that stands still, px or m
  double fraction_of_path = 2.0;  ///< of the path expected since the last measurement, added to the least radius

  template <int D>
  using Model = AlphaBetaVariable<D>;

  /// The same filter where one unit of length is `factor` of the new ones.
  AlphaBetaVariableOptions scaled(double factor) const {
    return {alpha, beta, first_radius * factor, min_radius * factor, fraction_of_path};
  }
};

template <int D>
class AlphaBetaVariable {
 public:
  using Options = AlphaBetaVariableOptions;
  static constexpr int dimension = D;

  AlphaBetaVariable(const Options& options, const Vector<D>& z, const Matrix<D>& R)
      : options_(options), filter_({options.alpha, options.beta, options.first_radius}, z, R) {}

  void predict(double dt) {
    filter_.predict(dt);
    since_correction_ += dt;
  }

  void correct(const Vector<D>& z, const Matrix<D>& R) {
    filter_.correct(z, R);
    speed_known_ = speed_known_ || since_correction_ > 0;
    since_correction_ = 0;
  }

  Vector<D> position() const { return filter_.position(); }
  Vector<D> velocity() const { return filter_.velocity(); }
  Matrix<D> covariance() const { return filter_.covariance(); }
  Matrix<D> innovation_covariance(const Matrix<D>& R) const { return filter_.innovation_covariance(R); }

  double search_radius() const {
    if (!speed_known_) return options_.first_radius;
    return options_.min_radius + options_.fraction_of_path * since_correction_ * filter_.velocity().norm();
  }

  /// The search area is a circle (a ball) of `search_radius()`.
  double gate_distance(const Vector<D>& z, const Matrix<D>& /*R*/) const { return (z - position()).norm() / search_radius(); }

 private:
  Options options_;
  AlphaBeta<D> filter_;
  double since_correction_ = 0;  // s
  bool speed_known_ = false;
};

}  // namespace marey::filter
