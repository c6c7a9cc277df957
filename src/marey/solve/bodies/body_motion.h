// How a body moves between two observations: with constant velocity and constant turning rate, but for accelerations that are white
// noise. Turn and place are followed apart, each as if it were alike in all directions, so that a step costs a few dozen operations
// instead of those of a filter of twelve states: these beliefs gate and predict; what is reported of a body that is seen is what
// was seen at that instant alone.
#pragma once

#include "marey/core/geometry.h"
#include "marey/geometry/rigid.h"

namespace marey::solve::bodies {

/// Variances of a coordinate and its rate, and what ties them.
struct RateBelief {
  double value = 0, both = 0, rate = 0;

  void predict(double dt, double acceleration) {
    const double noise = acceleration * acceleration * dt * dt;
    value += 2 * dt * both + dt * dt * rate + noise * dt * dt / 4;
    both += dt * rate + noise * dt / 2;
    rate += noise;
  }
  /// What a inspection with that variance changes: by how much of the innovation the value and its rate move.
  std::pair<double, double> correct(double variance) {
    const double sum = value + variance, gain = value / sum, rate_gain = both / sum;
    rate -= rate_gain * both;
    both *= 1 - gain;
    value *= 1 - gain;
    return {gain, rate_gain};
  }
};

struct BodyMotion {
  Rigid3 world_from_body;
  Vector<3> velocity = Vector<3>::Zero();      ///< m/s, of the origin
  Vector<3> turning_rate = Vector<3>::Zero();  ///< rad/s, about the world's axes
  RateBelief location, turn;

  /// A body that was seen there for the first time, with rates up to this much.
  static BodyMotion at(const Rigid3& pose, double rate, double turning_rate) {
    BodyMotion motion;
    motion.world_from_body = pose;
    motion.location = {1e-6, 0, rate * rate};
    motion.turn = {1e-4, 0, turning_rate * turning_rate};
    return motion;
  }

  void predict(double dt, double acceleration, double angular_acceleration) {
    world_from_body.translation += dt * velocity;
    world_from_body.rotation = geometry::rotation_from(dt * turning_rate) * world_from_body.rotation;
    location.predict(dt, acceleration);
    turn.predict(dt, angular_acceleration);
  }

  void correct(const Rigid3& detected, double turn_variance, double position_variance) {
    const auto [gain, rate_gain] = location.correct(position_variance);
    const Vector<3> shift = detected.translation - world_from_body.translation;
    world_from_body.translation += gain * shift;
    velocity += rate_gain * shift;
    const auto [turn_gain, turning_gain] = turn.correct(turn_variance);
    const Vector<3> angle = geometry::angle_axis_of(detected.rotation * world_from_body.rotation.transpose());
    world_from_body.rotation = geometry::rotation_from(turn_gain * angle) * world_from_body.rotation;
    turning_rate += turning_gain * angle;
  }
};

}  // namespace marey::solve::bodies
