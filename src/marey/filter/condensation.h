#pragma once

// CONDENSATION: the state of the target is a cloud of weighted particles. Each step selects particles by weight, predicts
// each by drift and diffusion, and observes: a particle's new weight is the likelihood of the measurement given its place.
// Any motion and any likelihood would do; the price is N times the work and an estimate that is noisy as 1/√N.
//
// Source: Isard, Blake, "CONDENSATION - conditional density propagation for visual tracking", IJCV 29, 1998; and Queiroz, Gomide,
// de Albuquerque Araujo, section III.C, who keep the position alone (N = 100) and take as search area what the particles cover.
// Deviations: selection is systematic (one random number, N even steps through the cumulative weights) instead of N independent
// draws: unbiased as well, less noisy, and linear in N. Diffusion is per √second, so that steps may vary. The likelihood is a
// normal density with the measurement's covariance widened by likelihood_sigma²; weights are formed from logarithms, so a
// measurement far from every particle selects the nearest instead of dividing 0 by 0.
// Cost: N normal numbers for each coordinate of the state, and N exponentials. Memory: allocated at the start alone.

#include <cstdint>
#include <vector>

#include "marey/filter/gaussian.h"
#include "marey/filter/random_stream.h"

namespace marey::filter {

template <int D>
class Condensation;

/// Lengths in px where the filter runs in the image, in m on the ground and in space.
struct CondensationOptions {
  int particles = 100;            ///< at least 1
  bool with_velocity = false;     ///< whether a particle has a velocity that it drifts with, or a position alone as in the paper
  double diffusion = 200;         ///< of the position, px/√s
  double velocity_diffusion = 0;  ///< of the velocity, px/s^1.5
  double likelihood_sigma = 4;    ///< px, added in squares to the measurement's own
  double initial_spread = 20;     ///< standard deviation of the first particles round the first measurement, px
  double initial_speed = 1000;    ///< standard deviation of their velocities per axis, px/s
  double search_spreads = 3;      ///< search radius over the weighted standard deviation of the particles
  std::uint64_t seed = 1;

  template <int D>
  using Model = Condensation<D>;

  /// The defaults for particles with a velocity.
  static CondensationOptions velocity() {
    CondensationOptions options;
    options.with_velocity = true;
    options.diffusion = 20;
    options.velocity_diffusion = 2000;
    return options;
  }

  /// The same filter where one unit of length is `factor` of the new ones.
  CondensationOptions scaled(double factor) const {
    CondensationOptions options = *this;
    options.diffusion *= factor;
    options.velocity_diffusion *= factor;
    options.likelihood_sigma *= factor;
    options.initial_spread *= factor;
    options.initial_speed *= factor;
    return options;
  }
};

template <int D>
class Condensation {
 public:
  using Options = CondensationOptions;
  static constexpr int dimension = D;
  static constexpr bool mixture = true;
  static constexpr bool sampled = true;

  Condensation(const Options& options, const Vector<D>& z, const Matrix<D>& R);

  /// Selects, drifts, diffuses.
  void predict(double dt);
  /// Observes.
  void correct(const Vector<D>& z, const Matrix<D>& R);

  Vector<D> position() const { return position_; }
  Vector<D> velocity() const { return velocity_; }
  Matrix<D> covariance() const { return covariance_; }
  Matrix<D> innovation_covariance(const Matrix<D>& R) const {
    return covariance_ + R + options_.likelihood_sigma * options_.likelihood_sigma * Matrix<D>::Identity();
  }

  double search_radius() const;

  /// The search area is a circle (a ball) of `search_radius()`.
  double gate_distance(const Vector<D>& z, const Matrix<D>& /*R*/) const { return (z - position_).norm() / search_radius(); }

 private:
  /// One row a coordinate, one column a particle.
  using Cloud = Eigen::Matrix<double, D, Eigen::Dynamic, Eigen::RowMajor>;

  void select();
  void diffuse(Cloud& cloud, double sigma);
  void summarise();

  Options options_;
  RandomStream random_;
  Cloud locations_;
  Cloud velocities_;  // empty if a particle has none
  Cloud selected_;    // scratch
  Eigen::RowVectorXd weights_;
  std::vector<int> chosen_;  // scratch
  bool even_ = true;         // whether all weights are alike
  Vector<D> position_;
  Vector<D> velocity_ = Vector<D>::Zero();
  Matrix<D> covariance_;
  // Without a velocity in the state, the estimates' own change is reported as one.
  Vector<D> last_estimate_;
  double since_correction_ = 0;
};

}  // namespace marey::filter
