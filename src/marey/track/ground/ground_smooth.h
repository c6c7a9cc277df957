// Where somebody was, from all that was seen before and after: Rauch, Tung & Striebel's smoother.
//
// People's velocities stray like a damped random walk (Ornstein & Uhlenbeck): white noise in the acceleration, and what velocity
// there is settles towards rest within some seconds. So a track that runs on blindly slows down and its uncertainty of place grows
// as time does, not as its cube: gaps of twenty seconds can be judged. While somebody is seen this is the usual constant velocity.
// Observations that do not fit (half a body hidden, the wrong foot) count for less: after each pass the covariance of each grows by
// its distance from the path, as Student's distribution would have it.
// The way back is taken in the form of Bryson & Frazier (Bierman 1973): an adjoint of four numbers instead of a covariance to
// invert. Cost: about 15 products of 2 × 2 matrices a sample and pass; 150 bytes a sample of one person while that one is smoothed.
// References: Rauch, Tung & Striebel, "Maximum likelihood estimates of linear dynamic systems", AIAA Journal 3 (1965); Bierman,
// "Fixed interval smoothing with discrete measurements", Int. J. Control 18 (1973); Lange, Little & Taylor, "Robust statistical
// modeling using the t distribution", JASA 84 (1989).
#pragma once

#include <span>
#include <vector>

#include "marey/core/time.h"
#include "marey/track/ground/ground_tracklet.h"

namespace marey {

struct GroundMotion {
  double acceleration = 2.5;  ///< square root of the spectral density of the acceleration's noise, m/s^1.5
  double settling = 3;        ///< time in which velocity falls to 1/e where nothing keeps it up, s

  /// Variance of a velocity of which nothing is known, per axis, (m/s)².
  double speed_variance() const { return acceleration * acceleration * settling / 2; }
};

/// A place and a velocity with their covariance, by blocks: m, m/s.
struct GroundState {
  Vector<2> place = Vector<2>::Zero();
  Vector<2> velocity = Vector<2>::Zero();
  Matrix<2> Ppp = Matrix<2>::Identity();
  Matrix<2> Ppv = Matrix<2>::Zero();
  Matrix<2> Pvv = Matrix<2>::Identity();
};

/// The state `dt` ≥ 0 seconds on.
GroundState predicted(const GroundState& state, double dt, const GroundMotion& motion);

/// What is known of one person at one instant.
struct GroundMoment {
  Vector<2> place = Vector<2>::Zero();
  Vector<2> velocity = Vector<2>::Zero();
  double fit = 1;  ///< weight of the observation, in (0, 1.5]: 1 where it fits as expected, small where it does not
};

/// The state at every sample, given all of them. `times` by instant; samples in the order of instants, at least one. The weights of
/// samples are found anew after each pass but the last; a single pass takes each as it says of itself.
std::vector<GroundMoment> smooth_ground(std::span<const GroundSample> samples, std::span<const Timestamp> times,
                                        const GroundMotion& motion, int passes = 3);

/// What the first samples, at most `span` seconds of them, say of the state at the first; or the last, of that at the last.
GroundState first_state(std::span<const GroundSample> samples, std::span<const Timestamp> times, const GroundMotion& motion,
                        double span);
GroundState last_state(std::span<const GroundSample> samples, std::span<const Timestamp> times, const GroundMotion& motion,
                       double span);

/// The likeliest place and velocity `since` seconds after `earlier` and `until` seconds before `later`, where nothing was seen;
/// both positive.
GroundMoment between(const GroundMoment& earlier, double since, const GroundMoment& later, double until,
                     const GroundMotion& motion);

}  // namespace marey
