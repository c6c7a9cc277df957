// Where a rigid body is, from where its markers are seen.
//
// From three markers or more that do not lie in a line: the motion of least squares in closed form (Arun, Huang, Blostein 1987),
// which for noise that is alike in all directions is the most probable one and reaches the Cramér-Rao bound. Its covariance is that
// bound: about the centroid of the markers turn and shift are independent, cov(shift) = σ² / N and cov(turn) = σ² (Σ |q|² I − q
// qᵀ)⁻¹ with q from the centroid; moved to the body's origin they are not. From fewer markers, or from some in a line: what was
// predicted, corrected by the observations (Gauss-Newton on the most probable pose), with the covariance that is left.
#pragma once

#include <optional>
#include <span>

#include "marey/core/geometry.h"
#include "marey/geometry/rigid.h"

namespace marey::solve::bodies {

struct PoseFit {
  Rigid3 world_from_body;
  Matrix<6> covariance = Matrix<6>::Zero();  ///< of a small turn about the world's axes (rad), then of the body's origin (m)
  double mean_error = 0;                     ///< m: of the markers' distances from where they are seen
  double sum_of_squares = 0;                 ///< m², of the same
};

/// `places` in the body's frame and where each is `seen` with a standard deviation of `sigma` m along each axis. Nothing for fewer
/// than three, or where they lie so near to a line that a turn about it is not known to `loosest_turn` rad.
std::optional<PoseFit> fit_pose(std::span<const Vector<3>> locations, std::span<const Vector<3>> detected, double sigma,
                                double loosest_turn = 0.2);

/// The prior of a pose before it is seen: the same in all directions.
struct PoseBelief {
  Rigid3 world_from_body;
  double turn_variance = 1;      ///< rad², about each axis
  double position_variance = 1;  ///< m², of the origin along each axis
};

/// Any number of markers, none included.
PoseFit correct_pose(const PoseBelief& belief, std::span<const Vector<3>> locations, std::span<const Vector<3>> detected,
                     double sigma);

/// [v]×: skew(v) w = v × w.
Matrix<3> skew(const Vector<3>& v);

}  // namespace marey::solve::bodies
