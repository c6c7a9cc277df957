// A person bound for a goal on the ground, as the director of a video moves one.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "marey/core/geometry.h"
#include "marey/simulate/people/figure.h"

namespace marey::simulate::people {

inline constexpr double kGain = 3.0;  // m/s²
inline constexpr double kTurn = 3.5;  // rad/s
// As abruptly as people can: they stop from a run within two steps, turn round in a quarter of a second, squat in a fifth.
inline constexpr double kAbruptGain = 12;  // m/s²
inline constexpr double kAbruptTurn = 12;  // rad/s
inline constexpr double kAbruptShape = 5;  // share of the whole change, 1/s

inline double wrapped(double angle) {
  return std::remainder(angle, 2 * std::numbers::pi);
}

/// A person bound for a goal.
struct Walker {
  int id = 0;
  Stance stance;
  double requested_speed = 0, requested_crouch = 0, requested_reach = 0;
  Vector<2> goal = Vector<2>::Zero();
  double rests_until = 0;  // s

  /// Moves on by dt; true where the goal is reached.
  bool walk(double now, double dt, double stature, bool abrupt) {
    const Vector<2> to_goal = goal - stance.location;
    const double wished_heading = std::atan2(to_goal.y(), to_goal.x());
    const double turn = wrapped(wished_heading - stance.heading);
    const double request = now < rests_until ? 0 : requested_speed * std::max(0.25, std::cos(std::min(std::abs(turn), 1.4)));
    const double gain = abrupt ? kAbruptGain : kGain;
    const double maximum = (abrupt ? kAbruptTurn : kTurn) * dt;
    stance.speed += std::clamp(request - stance.speed, -gain * dt, gain * dt);
    if (now >= rests_until) stance.heading += std::clamp(turn, -maximum, maximum);
    stance.crouch += std::clamp(requested_crouch - stance.crouch, -kAbruptShape * dt, kAbruptShape * dt);
    stance.reach += std::clamp(requested_reach - stance.reach, -kAbruptShape * dt, kAbruptShape * dt);
    step(dt, stature);
    return to_goal.norm() < std::max(0.4, 0.35 * stance.speed);
  }

  void step(double dt, double stature) {
    stance.location += stance.speed * dt * Vector<2>(std::cos(stance.heading), std::sin(stance.heading));
    stance.phase = wrapped(stance.phase + 2 * std::numbers::pi * stance.speed * dt / stride_length(stance.speed, stature));
  }
};

}  // namespace marey::simulate::people
