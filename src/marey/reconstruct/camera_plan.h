// Where to put cameras so that every point of a volume is seen well. A point's error is the Cramér-Rao bound of its triangulation,
// as triangulate.h has it: the inverse of the sum of what each camera that sees it says of it. What is sought is the set of places
// and directions with the largest mean of v = s² / (s² + σ²) over the points, s a centimetre's worth of the room, which counts a
// point that is not seen as 0 and rewards none for becoming better than it need be. Cameras are taken one by one, the best each
// time, and then each is put elsewhere as long as that helps (exchange, as in optimal design: Fedorov 1972). A prior of a tenth of
// the room lets a first camera count. Assumed: noise of all cameras alike, points everywhere alike. Cost: places × directions ×
// points × cameras × rounds of 3 × 3 inverses: a second for 6 cameras.
#pragma once

#include <vector>

#include "marey/core/planned_room.h"
#include "marey/core/rig.h"
#include "marey/geometry/camera.h"

namespace marey::reconstruct {

/// What cameras make of one place of the volume, over the sides from which it may be seen.
struct PlannedPoint {
  Vector<3> location = Vector<3>::Zero();  ///< m
  double covered = 0;                      ///< share of the sides that two cameras or more see from different directions
  double error_m = 0;                      ///< expected distance from the truth (root mean square) over those; 0 where none
};

/// How good a set of cameras is for a room.
struct RoomCoverage {
  std::vector<PlannedPoint> points;  ///< a grid: x fastest, then y, then z
  int columns = 0, rows = 0, layers = 0;
  double covered = 0;              ///< share of all points and sides
  double median_m = 0, p95_m = 0;  ///< of the expected errors where covered; 0 where nothing is
};

/// What these cameras see of the room. `noise_px`, obstacles and the farthest distance are the room's.
RoomCoverage coverage_of(const PlannedRoom& room, const std::vector<geometry::Camera>& cameras);

/// The cameras, best first, named cam1, …; no two at one mount while there are others. Deterministic. Throws Stopped; Error if no
/// camera at any mount sees the volume.
Rig plan_cameras(const PlannedRoom& room);

/// The expected error of a point that these cameras see: m, root mean square; nothing if they do not make a point of it.
std::optional<double> expected_error(const Vector<3>& location, const std::vector<geometry::Camera>& cameras, double noise_px);

}  // namespace marey::reconstruct
