// The generalised forces of a motion: what must act along each coordinate, beside gravity and the loads from outside, so that the
// skeleton moves as it does (joint moments where a coordinate is an angle).
//
// Newton and Euler, recursively: velocities and accelerations of the segments from the root outwards, one elementary turn or shift
// of a joint after the other, forces back inwards. Exact for every joint whose axes are functions of one coordinate. Every
// coordinate is treated as its own, also one that is locked or follows from another: f = M(q)·q̈ + C(q, q̇) − g − loads, as OpenSim's
// InverseDynamicsSolver has it. Cost linear in the axes.
#pragma once

#include <span>
#include <vector>

#include "marey/core/segment_mass.h"
#include "marey/core/skeleton.h"

namespace marey::solve::skeleton {

/// A force from outside on a segment.
struct SegmentLoad {
  int segment = 0;
  Vector<3> force = Vector<3>::Zero();   ///< N, in the world
  Vector<3> point = Vector<3>::Zero();   ///< m, in the world: where the force acts
  Vector<3> moment = Vector<3>::Zero();  ///< N m, in the world, about that point
};

/// A coordinate's value and its first two derivatives by time, one each of the skeleton's coordinates; those that follow from
/// others have theirs too.
struct CoordinateMotion {
  std::vector<double> value, speed, acceleration;
};

inline constexpr double kGravity = 9.80665;  ///< m/s², along −z; physical

/// One a coordinate: N m, or N where it is a shift. `masses` are one a segment.
std::vector<double> inverse_dynamics(const Skeleton& skeleton, std::span<const SegmentMass> masses, const CoordinateMotion& motion,
                                     std::span<const SegmentLoad> loads, double gravity = kGravity);

/// Sets value, speed and acceleration of the coordinates that follow from others.
void couple(const Skeleton& skeleton, CoordinateMotion& motion);

}  // namespace marey::solve::skeleton
