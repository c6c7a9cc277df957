// A person as a generalised cylinder that stands on the ground, and which points of an image's grid it covers.
//
// Source: Isard, MacCormick, "BraMBLe: A Bayesian Multiple-Blob Tracker", ICCV 2001, from memory. Remembered: circles of given
// radii one above the other (feet, waist, shoulders, head), projected by a calibrated camera. Ours: the radii, which are those of a
// person who walks, and that two numbers, stature and girth, are all that a person differs in.
#pragma once

#include <cstdint>
#include <vector>

#include "marey/core/blob_evidence.h"
#include "marey/core/geometry.h"
#include "marey/geometry/camera.h"

namespace marey::track::bramble {

struct PersonCylinder {
  Vector<3> foot = Vector<3>::Zero();  ///< m, in the world: the middle of the lowest circle
  double stature = 1.75;               ///< m
  double girth = 1;                    ///< factor on all radii
};

/// A closed polygon, px; empty if a part of the person lies behind the camera.
using CylinderOutline = std::vector<Vector<2>>;
CylinderOutline cylinder_outline(const Camera& camera, const PersonCylinder& person);

/// Neighbouring points of one row of a grid: columns `begin` to one before `end`; none where they are equal.
struct RowSpan {
  std::int16_t begin = 0, end = 0;
};

/// The points of a grid within an outline, row by row from `top` on. What lies outside the grid is omitted and counted in `cut`.
struct GridShape {
  int top = 0;
  std::vector<RowSpan> rows;
  int points = 0;           ///< within the grid
  int all_rows = 0;         ///< of the outline, those outside the grid too
  int left = 0, right = 0;  ///< columns, one past the last, that hold all rows

  int bottom() const { return top + static_cast<int>(rows.size()); }
  /// Of the outline's rows, those of which points lie within the grid.
  double fraction_in_grid() const { return all_rows > 0 ? static_cast<double>(rows.size()) / all_rows : 0; }
};

/// Each row's points from the outline's leftmost to its rightmost edge there. Into `shape`, whose memory is used again. `grid`: its
/// log_ratio's size, origin and step.
void cover(const CylinderOutline& outline, const BlobEvidence& grid, GridShape& shape);

}  // namespace marey::track::bramble
