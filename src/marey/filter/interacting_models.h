#pragma once

// Interacting multiple models: Kalman filters side by side, one for a target whose velocity is steady, one for a target that
// accelerates, one for a target that turns, one for a target that swerves. Each measurement says how likely each model is; before
// each prediction the models' states are mixed by the chance that the target has changed from one to another. The estimate is their
// mean, weighted by their probabilities. Steady while the target is steady and quick when it is not, without a threshold.
//
//   steady  constant velocity under small white acceleration.
//   pull    Singer's acceleration, which fades: quadratic at first and bounded in a gap.
//   turn    the turn in the plane of velocity and acceleration at the rate |v × a| / |v|² of the mixed state, in the plane and in
//           space alike (Bar-Shalom, Li, Kirubarajan, section 11.7), the rate held back where the velocity is uncertain.
//   swerve  the velocity jumps by a share of the speed within this very step: the corner of a zigzag, a hit, a ball's bounce.
//           Lasts one step, and comes `swerve_rate` times a second however long a step is.
//
// All share one state, position, velocity and acceleration, so mixing needs no translation. UnoccludedMotion and swerve know no
// acceleration: theirs is one that begins now, of mean 0 and the variance of pull's, so that a target that starts to accelerate
// is met with an open mind, not with the certainty that its acceleration is 0. Sizes follow the speed: a thing that moves fast
// through the image, being near or quick, also swerves by more pixels. Of steady, pull and turn, a target still is in the one it
// was in after dt with probability exp(−dt/mode_time), and else in any by `shares`.
//
// Source: Blom, Bar-Shalom, "The interacting multiple model algorithm for systems with Markovian switching coefficients", IEEE
// Trans. AC 33, 1988, steps 1-4 as in Bar-Shalom, Li, Kirubarajan, section 11.6.6. Deviations: the above, and the search area,
// which is the union of the models' ellipses: one ellipse for all would be too wide for the steady and too narrow for a corner.
// Cost: four predictions and updates of filter/kinematics.h, two of them of position and velocity alone, and the mixing; nothing
// is allocated.

#include <array>

#include "marey/filter/gaussian.h"
#include "marey/filter/kinematics.h"

namespace marey::filter {

template <int D>
class InteractingModels;

/// Lengths in px where the filter runs in the image, in m on the ground and in space.
struct InteractingModelsOptions {
  double constant_noise = 20;      ///< white acceleration of the steady model, square root of its density, px/s^1.5
  double acceleration = 100;       ///< standard deviation of the acceleration at rest, px/s²
  double agility = 8;              ///< what is added to it for each unit of speed, 1/s
  double acceleration_time = 0.3;  ///< how long an acceleration lasts, s
  double turn_limit = 20;          ///< the fastest turn, rad/s
  double swerve_rate = 1;          ///< how often the velocity jumps, 1/s
  double swerve_speed = 250;       ///< standard deviation of a jump at rest, per axis, px/s
  double swerve_fraction = 0.7;    ///< what is added to it for each unit of speed
  double mode_time = 0.5;          ///< how long a target keeps to one of steady, pull, turn, s
  std::array<double, 3> fractions = {0.5, 0.35, 0.15};  ///< of the time spent in each of them; they add up to 1
  double initial_speed = 1000;                          ///< standard deviation per axis before anything is known, px/s
  double gate_sigmas = 4;  ///< border of the search area, in standard deviations of the innovation of each model

  template <int D>
  using Model = InteractingModels<D>;

  /// The same filter where one unit of length is `factor` of the new ones.
  InteractingModelsOptions scaled(double factor) const {
    InteractingModelsOptions options = *this;
    options.constant_noise *= factor;
    options.acceleration *= factor;
    options.swerve_speed *= factor;
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
  static constexpr std::size_t kModels = 4;
  enum : std::size_t { kStationary, kPull, kTurn, kSwerve };

  InteractingModels(const Options& options, const Vector<D>& z, const Matrix<D>& R);

  void predict(double dt);
  /// The same while the target is hidden: the models run on side by side, unmixed, and none swerves. The state of a steady
  /// target thus stays as sharp as it was, however many steps nothing is seen of it.
  void predict_unobserved(double dt);
  void correct(const Vector<D>& z, const Matrix<D>& R);

  Vector<D> position() const { return position_; }
  Vector<D> velocity() const { return velocity_; }
  Matrix<D> covariance() const { return covariance_; }
  Matrix<D> innovation_covariance(const Matrix<D>& R) const { return covariance_ + R; }

  /// Density of a measurement at z, all models together: what makes one pairing of targets and measurements likelier than another.
  double log_likelihood(const Vector<D>& z, const Matrix<D>& R) const;

  /// The search area is the union of the models' ellipses (ellipsoids) of `gate_sigmas` standard deviations.
  double gate_distance(const Vector<D>& z, const Matrix<D>& R) const;

  /// No measurement whose covariance is at most `variance` in any direction lies in the search area and farther than this from
  /// position(): cheap to ask before gate_distance.
  double search_reach(double variance) const;

  /// Of steady, pull, turn, swerve; they add up to 1.
  const std::array<double, kModels>& probabilities() const { return probabilities_; }
  /// Their states, position, velocity and acceleration.
  const std::array<kinematics::State<D, 3>, kModels>& states() const { return states_; }

 private:
  using State = kinematics::State<D, 3>;

  /// Whether the model has an acceleration of its own.
  static constexpr bool is_curved(std::size_t model) { return model == kPull || model == kTurn; }

  double chance_of_change(std::size_t from, std::size_t to, double keep, double swerve) const;
  void mix(double dt);
  void move(double dt, const Matrix<2>& swerve);
  void summarise();

  Options options_;
  std::array<State, kModels> states_;
  std::array<double, kModels> probabilities_;
  Vector<D> position_;
  Vector<D> velocity_ = Vector<D>::Zero();
  Matrix<D> covariance_;
};

/// The rate of turn, rad/s, of a target with this velocity (and its covariance) and acceleration: |v × a| / (|v|² + variance of v).
template <int D>
double turn_rate(const Vector<D>& velocity, const Matrix<D>& covariance, const Vector<D>& acceleration, double limit);

}  // namespace marey::filter
