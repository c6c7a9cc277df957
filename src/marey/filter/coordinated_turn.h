#pragma once

// The coordinated turn: a target that turns at a steady rate at a steady speed, for the extended and the unscented filter.
//
// State: position, velocity, rate of turn. In the plane the rate is one number (rad/s, from the first axis to the second); in
// space it is the vector along the axis of the turn, so that the turn lies in the plane of the velocity, whichever that is, and
// no axis is special. Its part along the velocity moves nothing and is not observed: it only fades. Over a step the velocity
// turns by v' = v + A (θ × v) + B (θ × (θ × v)) with θ = rate · dt, A = sin θ/θ, B = (1 − cos θ)/θ² (Rodrigues's formula), and
// the position gains its integral; as θ → 0 this is the straight line, and near 0 series are used, so nothing divides by zero.
// Noise: white acceleration in the velocity; the rate fades towards 0 with a time constant and is renewed as much, so that its
// variance stays bounded while the target stands still and nothing can be learnt of it.
// Source: Bar-Shalom, Li, Kirubarajan, "Estimation with Applications to Tracking and Navigation", 2001, section 11.7; the
// fading rate and the turn in space are ours.

#include "marey/core/geometry.h"

namespace marey::filter {

/// Lengths in px where the filter runs in the image, in m on the ground and in space.
struct TurnNoise {
  double acceleration_noise = 200;  ///< square root of the spectral density, px/s^1.5
  double turn_sigma = 3;            ///< standard deviation of the rate of turn, rad/s
  double turn_time = 2;             ///< how long a rate of turn lasts, s
};

template <int D>
struct CoordinatedTurn {
  static constexpr int kTurn = D == 2 ? 1 : 3;  ///< entries of the rate of turn
  static constexpr int kSize = 2 * D + kTurn;   ///< of the state: position, velocity, rate of turn
  using State = Vector<kSize>;
  using Square = Matrix<kSize>;

  /// The state dt seconds on. Writes the Jacobian with respect to `x` where asked to.
  static State move(const State& x, double dt, const TurnNoise& noise, Square* jacobian = nullptr);

  /// Covariance of what the noise adds in dt seconds.
  static Square noise(double dt, const TurnNoise& noise);

  /// The state at a first measurement, at rest.
  static State start(const Vector<D>& z);
  static Square start_covariance(const Matrix<D>& R, double initial_speed, const TurnNoise& noise);
};

}  // namespace marey::filter
