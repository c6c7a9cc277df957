// Joints' centres and axes from how two segments move against each other, instead of from where markers are said to sit.
//
// A ball's centre is the point that stays fixed in both segments (SCoRE, the symmetrical centre of rotation estimation; Ehrig,
// Taylor, Duda, Heller 2006): the least squares solution (c₁, c₂) of R₁ₜ c₁ + p₁ₜ = R₂ₜ c₂ + p₂ₜ over all instants t,
// with world_from_segment (R, p). A hinge's axis is what that system does not determine (SARA; the same authors 2007): the right
// singular vector (v₁, v₂) of [R₁ₜ, −R₂ₜ] of the least singular value has the axis' directions v₁/|v₁| and v₂/|v₂| in the two
// segments, and the solution of least length without it a point of the axis.
//
// How far off it may be is more than the residuals say, for skin moves slowly and with the joint. The motion is cut in ten pieces
// in a row, each is omitted in turn, and what the ten solutions differ by is one part of the deviation (the delete-a-group
// jackknife). The other, of a centre, is what the gap between the segments' centres would do if it repeated with the joint's
// angles. Cost: a few operations an instant, eleven times.
#pragma once

#include <optional>
#include <span>

#include "marey/core/geometry.h"
#include "marey/geometry/rigid.h"

namespace marey::solve::skeleton {

/// world_from_segment by instant; nothing if it was not seen.
using SegmentPoses = std::span<const std::optional<geometry::Rigid3>>;

struct FunctionalCentre {
  Vector<3> in_parent = Vector<3>::Zero();  ///< m, in the parent's frame
  double deviation_m = 0;                   ///< one standard deviation of it, all directions together
  double gap_m = 0;                         ///< RMS distance between the centre as the one and the other segment has it
  int instants = 0;                         ///< in which both were seen
};

struct FunctionalAxis {
  Vector<3> point = Vector<3>::Zero();       ///< m, in the parent's frame: a point of it
  Vector<3> direction = Vector<3>::UnitY();  ///< in the parent's frame, of length 1, either way
  double deviation_rad = 0;                  ///< one standard deviation of the direction
  double rotated_rad = 0;                    ///< how far the joint turned about it: from the least to the most
  int instants = 0;
};

/// SCoRE. Nothing if fewer than 30 instants show both segments, or the joint turned about one axis at most.
std::optional<FunctionalCentre> functional_centre(SegmentPoses parent, SegmentPoses child);
/// SARA. Nothing if fewer than 30 instants show both segments, or the joint barely turned.
std::optional<FunctionalAxis> functional_axis(SegmentPoses parent, SegmentPoses child);

}  // namespace marey::solve::skeleton
