// Force plates: where they are in the world, and the loads that they measured.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "marey/core/geometry.h"

namespace marey {

/// Force and moment of one sample.
struct PlateLoad {
  Vector<3> force = Vector<3>::Zero();   ///< N, in the world
  Vector<3> moment = Vector<3>::Zero();  ///< N m, in the world, about the middle of the plate's surface
};

/// A plate in the world (m, z up). As C3D specifies its corners, 1 is where the plate's x and y are positive, 2 where x is negative
/// and y positive, then 3, 4; the plate's z points into the floor.
struct ForcePlate {
  std::string name;
  int type = 2;  ///< C3D's FORCE_PLATFORM:TYPE
  std::array<Vector<3>, 4> corners = {Vector<3>::Zero(), Vector<3>::Zero(), Vector<3>::Zero(), Vector<3>::Zero()};
  double rate_hz = 0;  ///< samples per second
  double begin_s = 0;  ///< the recording's time of the first sample
  std::vector<PlateLoad> loads;
  std::vector<std::uint8_t> saturated;  ///< by sample: a channel was at its limit; empty if none ever was

  Vector<3> centre() const { return (corners[0] + corners[1] + corners[2] + corners[3]) / 4; }
  /// World from plate: the plate's axes as columns.
  Matrix<3> axes() const {
    const Vector<3> x = (corners[0] + corners[3] - corners[1] - corners[2]).normalized();
    const Vector<3> z = x.cross(corners[0] + corners[1] - corners[2] - corners[3]).normalized();
    Matrix<3> axes;
    axes << x, z.cross(x), z;
    return axes;
  }
};

}  // namespace marey
