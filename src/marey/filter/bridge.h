// What lies in a gap between two known states: the one gap filler.
//
// Each coordinate moves by x(t + dt) = F x(t) + noise of covariance Q, and is known at both ends. This is the mean of all paths
// between them, given both:
//   x = F₁ a + C (b − F₂ F₁ a),   C = Q₁ F₂ᵀ (F₂ Q₁ F₂ᵀ + Q₂)⁻¹
// With a random walk that is the straight line, with white acceleration Hermite's cubic through places and velocities, with
// people's motion on the ground (track/ground/offline/ground_smooth.h) their likeliest motion. Where something else predicts the
// gap (a tracker, companions, a polynomial), the bridge spreads the errors of that prediction at both ends over the gap. Source:
// the smoother's equations for one unobserved instant (Rauch, Tung & Striebel 1965). Cost: a product and an inverse of order ×
// order matrices for each time that is asked for.
#pragma once

#include <cmath>

#include <Eigen/LU>

#include "marey/core/geometry.h"

namespace marey::filter {

/// How one coordinate's state continues over a step: x becomes F x, and noise of covariance Q comes in.
template <int N>
struct Transition {
  Matrix<N> F = Matrix<N>::Identity();
  Matrix<N> Q = Matrix<N>::Zero();
};

/// Places stray by `noise` in a second: state of the place alone.
struct RandomWalk {
  static constexpr int order = 1;
  double noise = 1;  ///< square root of the density, 1/√s of the unit of length
  Transition<1> over(double dt) const;
};

/// Velocities stray by `noise` in a second: place and velocity.
struct WhiteAcceleration {
  static constexpr int order = 2;
  double noise = 1;  ///< square root of the acceleration's density, 1/s^1.5 of the unit of length
  Transition<2> over(double dt) const;
};

/// `Motion` has the `order` of its state, and what it does `over(dt)`, a Transition<order>. D coordinates move alike.
template <typename Motion, int D>
class Bridge {
 public:
  static constexpr int N = Motion::order;
  /// Rows: the place, its derivative, …; a column for each coordinate.
  using State = Eigen::Matrix<double, N, D>;

  /// From `before` at time `begin` to `after` at time `end`, s; begin < end.
  Bridge(const State& before, double begin, const State& after, double end, const Motion& motion = {})
      : before_(before), after_(after), begin_(begin), end_(end), motion_(motion) {}

  /// The likeliest state at a time between both.
  State at(double time) const {
    const Transition<N> one = motion_.over(time - begin_), two = motion_.over(end_ - time);
    const State expected = one.F * before_;
    return expected + gain(one, two) * (after_ - two.F * expected);
  }

  /// The covariance of each coordinate's state then, if both ends are exact.
  Matrix<N> covariance(double time) const {
    const Transition<N> one = motion_.over(time - begin_), two = motion_.over(end_ - time);
    return one.Q - gain(one, two) * two.F * one.Q;
  }

 private:
  static Matrix<N> gain(const Transition<N>& one, const Transition<N>& two) {
    return one.Q * two.F.transpose() * (two.F * one.Q * two.F.transpose() + two.Q).inverse();
  }

  State before_, after_;
  double begin_, end_;
  Motion motion_;
};

inline Transition<1> RandomWalk::over(double dt) const {
  return {Matrix<1>::Identity(), Matrix<1>(noise * noise * dt)};
}

inline Transition<2> WhiteAcceleration::over(double dt) const {
  const double q = noise * noise;
  Transition<2> step;
  step.F << 1, dt, 0, 1;
  step.Q << q * dt * dt * dt / 3, q * dt * dt / 2, q * dt * dt / 2, q * dt;
  return step;
}

}  // namespace marey::filter
