// How the people of a recording move, learned from tracks of it: footballers turn within a step, passers-by go straight for
// minutes. The strength of accelerations is the likeliest under a constant-velocity Kalman filter run over the tracks, errors of
// places with Student's tails, together with a factor on these errors, so that a detector's noise is not taken for people's haste;
// both on a grid. Cost: some 60 short filters over at most 20,000 samples.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/core/time.h"
#include "marey/track/ground/offline/ground_tracklet.h"

namespace marey::track::ground {

struct MotionStatistics {
  double acceleration = 2;  ///< velocity strays by this each √second, m/s^1.5
  double speed = 3;         ///< root mean square of each component of the velocity, m/s
};

/// Nothing if the tracks are too few or too short. `times` by instant.
std::optional<MotionStatistics> learn_walk(std::span<const offline::GroundTracklet> tracklets, std::span<const Timestamp> times);

}  // namespace marey::track::ground
