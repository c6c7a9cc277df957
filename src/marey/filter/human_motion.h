// What no person can have done: pieces of a path over the ground that are faster, or change velocity faster, than people can.
//
// Round each instant a parabola is laid through the places within reach, weighed by their covariances; its velocity and
// acceleration are held against what the fastest people do. No person exceeds a top speed; legs push with this much in any
// direction, braking and turning included; and forwards with the less, the faster one is already, down to nothing at the top speed
// (the acceleration-speed profile of sprinters, nearly a straight line: Morin et al., "Individual acceleration-speed profile
// in-situ", J. Biomech. 123, 2021). A piece is impossible only where it is so by more than its uncertainty, so that noise at the
// far side of a pitch is not one.
//
// The one who follows people by what cameras see breaks these limits in two cases, which are separated by leaving the piece out.
// Where one body can have gone from where it was before to where it is after, the places between were wrong: a foot that was
// hidden, a shadow. Where it cannot, those before and after are two people: a box has slid from one to the other. Assumes that
// errors of places persist for some hundredths of a second. Cost: one solution of six unknowns an instant, over the places within
// reach.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "marey/core/geometry.h"

namespace marey::filter {

/// By the fastest that were measured: 12.4 m/s over 100 m, about 10 m/s² out of the blocks.
struct HumanLimits {
  double speed = 12.5;       ///< m/s
  double acceleration = 10;  ///< m/s²
};

struct HumanMotionOptions {
  HumanLimits limits;
  double reach = 0.4;          ///< s before and after that give velocity and acceleration
  double error_memory = 0.05;  ///< s for which errors of places persist
  double sigmas = 3;           ///< standard deviations by which limits must be broken
};

/// Where a person was.
struct TimedPosition {
  double time = 0;                               ///< s
  Vector<2> location = Vector<2>::Zero();        ///< m
  Matrix<2> covariance = Matrix<2>::Identity();  ///< m²
};

/// From the place `first` to the place `last`, both included.
struct ImpossiblePiece {
  std::size_t first = 0, last = 0;
  bool one_person = true;  ///< who was there before can be who is there after: only the places between are wrong
};

/// By time; pieces do not touch. `places` by growing time. Where places are farther apart than the reach nothing is known of speed
/// between them, but that no person exceeds the limit.
std::vector<ImpossiblePiece> impossible_pieces(std::span<const TimedPosition> locations, const HumanMotionOptions& options = {});

}  // namespace marey::filter
