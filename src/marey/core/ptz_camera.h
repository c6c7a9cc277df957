#pragma once

#include <optional>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/geometry/tripod.h"

namespace marey {

/// How a camera on a tripod was turned and zoomed, frame by frame; turns by time.
struct PtzCamera {
  struct Turn {
    double time_s = 0;                         ///< by the camera's own clock: the frame's
    std::optional<geometry::Heading> heading;  ///< nothing: it is not known where the camera was aimed (a cut, a replay)
    Matrix<3> covariance = Matrix<3>::Zero();  ///< of pan, tilt, rad, and ln of the focal length
    /// The same for a camera on an exact tripod that errs as much on the pitch in view: by it the places seen are judged. The
    /// tripod's error turns pan and tilt along with it, so `covariance` would say too much of them. Nothing: `covariance`.
    std::optional<Matrix<3>> position_covariance;
  };

  geometry::Tripod tripod;
  std::vector<Turn> rotations;
};

}  // namespace marey
