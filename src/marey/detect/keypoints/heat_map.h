// Where a point is, and how well that is known, out of a network's heat map: logits, cell by cell, that the point is there.
//
// The networks give each point twice: as a place (regression) and as a map. As in MediaPipe's own graph
// (refine_landmarks_from_heatmap) the place is moved to the map's mean in the 7 × 7 cells around it where the map is sure. On the
// videos of a person on a beam that halves the distance to another program's points where the region is loose. The covariance is
// the second moment, about that place, of what reaches a quarter of the map's peak: a map with two peaks gives a wide one. Against
// the same points it is as large as their distance says, from 11 to 160 px (docs/markerless.md).
#pragma once

#include <span>

#include "marey/core/geometry.h"

namespace marey::detect::keypoints {

/// In px of the network's input, which count from its edge.
struct HeatPoint {
  Vector<2> location = Vector<2>::Zero();
  Matrix<2> covariance = Matrix<2>::Identity();
};

/// `logits`: `cells` × `cells`, row by row; `cell` px each. `given` is the network's own place for the point.
HeatPoint point_in(std::span<const float> logits, int cells, double cell, const Vector<2>& given);

}  // namespace marey::detect::keypoints
