// Where a person was, from all that was seen before and after: Rauch, Tung & Striebel's smoother.
//
// People push for some tenths of a second in one direction and then in another, and what velocity they have settles towards rest
// within some seconds where nothing keeps it up: acceleration is an Ornstein-Uhlenbeck process (Singer 1970), and velocity is
// damped. So what is faster than a push is taken for noise and not for motion, while a track that runs on blindly slows down and
// its uncertainty of place grows as time does, not as its cube: gaps of twenty seconds can be evaluated. One who stands or strolls
// pushes less than who plays: after each pass the strength of the pushes is taken from those found round each instant, so that the
// jitter of places does not make people walk who stand. Neighbouring observations err alike (the same foot ahead, the same shadow),
// and count as this much less. Observations that do not fit (half a body hidden, the wrong foot) count for less: after each pass
// the covariance of each grows by its distance from the path, as in Student's distribution. The backward pass is taken in the
// form of Bryson & Frazier (Bierman 1973): an adjoint of six numbers instead of a covariance to invert. Cost: about 15 products of
// 2 × 2 matrices a sample and pass, and a few of 6 × 6 in the last one, for the covariance of places; 180 bytes a sample of one
// person while that one is smoothed. References: Rauch, Tung & Striebel, "Maximum likelihood estimates of linear dynamic systems",
// AIAA Journal 3 (1965); Bierman, "Fixed interval smoothing with discrete measurements", Int. J. Control 18 (1973); Lange, Little &
// Taylor, "Robust statistical modeling using the t distribution", JASA 84 (1989).
#pragma once

#include <span>
#include <vector>

#include "marey/core/time.h"
#include "marey/filter/position_smoother.h"
#include "marey/track/ground/offline/ground_tracklet.h"

namespace marey::track::ground::offline {

struct GroundMotion {
  double acceleration = 1.5;   ///< by which velocity strays in a second, m/s: root of the density of slow changes, m/s^1.5
  double push = 0.5;           ///< for this long people push in one direction, s
  double settling = 3;         ///< time in which velocity falls to 1/e where nothing keeps it up, s
  double calm = 0.1;           ///< share of the pushes' typical power that who stands is still granted; 1: all push alike
  double error_memory = 0.05;  ///< for this long errors of places persist, s; 0: each errs on its own

  static constexpr int order = 3;
  /// What it does to place, velocity and acceleration of each axis in `dt` ≥ 0 seconds, where people push as normal.
  filter::Transition<3> over(double dt) const;
};

/// Place, velocity and acceleration with their covariance, by blocks: m, m/s, m/s².
struct GroundState : filter::MovingState<GroundMotion::order, 2> {
  Vector<2> location() const { return x[0]; }
  Vector<2> velocity() const { return x[1]; }
  /// Of place and velocity.
  Matrix<4> covariance() const { return (Matrix<4>() << P[0], P[1], P[1].transpose(), P[3]).finished(); }
};

/// Variance of the velocity of people without observations, per axis, (m/s)².
double speed_variance(const GroundMotion& motion);

/// The state `dt` ≥ 0 seconds on.
GroundState predicted(const GroundState& state, double dt, const GroundMotion& motion);

/// The state of one person at one instant.
struct GroundTimeStep {
  Vector<2> location = Vector<2>::Zero();
  Vector<2> velocity = Vector<2>::Zero();
  Vector<2> acceleration = Vector<2>::Zero();
  double fit = 1;  ///< weight of the observation, in (0, 1.5]: 1 where it fits as expected, small where it does not
  Matrix<2> spread = Matrix<2>::Zero();  ///< covariance of `place`, m²
};

/// The state at every sample, given all of them. `times` by instant; samples in the order of instants, at least one. The weights of
/// samples are found again after each pass but the last; a single pass takes each as it says of itself.
std::vector<GroundTimeStep> smooth_ground(std::span<const GroundSample> samples, std::span<const Timestamp> times,
                                          const GroundMotion& motion, int passes = 3);

/// What the first samples, at most `span` seconds of them, say of place and velocity at the first; or the last, of those at the
/// last.
GroundState first_state(std::span<const GroundSample> samples, std::span<const Timestamp> times, const GroundMotion& motion,
                        double span);
GroundState last_state(std::span<const GroundSample> samples, std::span<const Timestamp> times, const GroundMotion& motion,
                       double span);

}  // namespace marey::track::ground::offline
