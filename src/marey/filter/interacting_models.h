#pragma once

// Interacting multiple models: three Kalman filters side by side, one for a target that cruises, one for a target that
// accelerates, one for a target that turns. Each measurement tells how likely each model is; before each prediction the
// models' states are mixed by the chance that the target has changed from one to another. The estimate is their mean, weighted
// by their probabilities. Steady while the target is steady and quick when it is not, without a threshold to tell which.
//
// All three share one state, position, velocity and acceleration, so mixing needs no translation:
//   cruise  constant velocity under small white acceleration. Its acceleration entry is one that begins now: mean 0 and the
//           variance of the accelerating model, so that a target that starts to accelerate is met with an open mind, not with
//           the certainty that its acceleration is 0.
//   pull    Singer's acceleration, which fades: quadratic at first and bounded in a gap.
//   turn    the turn in the plane of velocity and acceleration at the rate |v × a| / |v|² of the mixed state, in the plane and in
//           space alike (Bar-Shalom, Li, Kirubarajan, section 11.7), the rate held back where the velocity is uncertain.
// Sizes: a target's acceleration is taken as `acceleration` plus `agility` times its speed, because a thing that moves fast
// through the image, being near or quick, also swerves by more pixels. The chance of a change of model follows from the time:
// after dt a target still is in the model it was in with probability exp(−dt/mode_time), and else in any by `shares`.
//
// Source: Blom, Bar-Shalom, "The interacting multiple model algorithm for systems with Markovian switching coefficients", IEEE
// Trans. AC 33, 1988, steps 1-4 as in Bar-Shalom, Li, Kirubarajan, section 11.6.6. Deviations: the above; the spread of the
// means is summed over pairs of models, which is the same in exact arithmetic and stays positive in rounding; probabilities are
// formed from logarithms of likelihoods, so a measurement far from every model changes nothing into NaN.
// Cost: three predictions and three updates of filter/kinematics.h, and the mixing; nothing is allocated.

#include <array>

#include "marey/filter/gaussian.h"
#include "marey/filter/kinematics.h"

namespace marey {

template <int D>
class InteractingModels;

/// Lengths in px where the filter runs in the image, in m on the ground and in space.
struct InteractingModelsOptions {
  double cruise_noise = 20;        ///< white acceleration of the cruising model, square root of its density, px/s^1.5
  double acceleration = 100;       ///< standard deviation of the acceleration at rest, px/s²
  double agility = 5;              ///< what is added to it for each unit of speed, 1/s
  double acceleration_time = 0.3;  ///< how long an acceleration lasts, s
  double turn_limit = 20;          ///< the fastest turn, rad/s
  double mode_time = 0.3;          ///< how long a target keeps to one model, s
  std::array<double, 3> shares = {0.5, 0.35, 0.15};  ///< of the time spent cruising, pulling, turning; they add up to 1
  double initial_speed = 1000;                       ///< standard deviation per axis before anything is known, px/s
  double gate_sigmas = 4;                            ///< border of the search area, in standard deviations of the innovation

  template <int D>
  using Model = InteractingModels<D>;

  /// The same filter where one unit of length is `factor` of the new ones.
  InteractingModelsOptions scaled(double factor) const {
    InteractingModelsOptions options = *this;
    options.cruise_noise *= factor;
    options.acceleration *= factor;
    options.initial_speed *= factor;
    return options;
  }
};

template <int D>
class InteractingModels {
 public:
  using Options = InteractingModelsOptions;
  static constexpr int dimension = D;
  static constexpr bool mixture = true;
  static constexpr std::size_t kModels = 3;
  enum : std::size_t { kCruise, kPull, kTurn };

  InteractingModels(const Options& options, const Vector<D>& z, const Matrix<D>& R);

  void predict(double dt);
  void correct(const Vector<D>& z, const Matrix<D>& R);

  Vector<D> position() const { return position_; }
  Vector<D> velocity() const { return velocity_; }
  Matrix<D> covariance() const { return covariance_; }
  Matrix<D> innovation_covariance(const Matrix<D>& R) const { return covariance_ + R; }

  /// The search area is the ellipse (the ellipsoid) of `gate_sigmas` standard deviations of all models together.
  double gate_distance(const Vector<D>& z, const Matrix<D>& R) const {
    return mahalanobis<D>(z - position_, innovation_covariance(R)) / options_.gate_sigmas;
  }

  /// Of cruise, pull, turn; they add up to 1.
  const std::array<double, kModels>& probabilities() const { return probabilities_; }
  const std::array<kinematics::State<D, 3>, kModels>& states() const { return states_; }

 private:
  void mix(double dt);
  void summarise();

  Options options_;
  std::array<kinematics::State<D, 3>, kModels> states_;
  std::array<double, kModels> probabilities_;
  Vector<D> position_;
  Vector<D> velocity_ = Vector<D>::Zero();
  Matrix<D> covariance_;
};

/// The rate of turn, rad/s, of a target with this velocity (and its covariance) and acceleration: |v × a| / (|v|² + variance of v).
template <int D>
double turn_rate(const Vector<D>& velocity, const Matrix<D>& covariance, const Vector<D>& acceleration, double limit);

}  // namespace marey
