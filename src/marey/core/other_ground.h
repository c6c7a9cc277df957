#pragma once

#include <functional>

#include "marey/core/recording.h"

namespace marey {

/// How places on the ground of one frame of reference are told in another; affine, m to m.
struct GroundChange {
  std::function<Vector<2>(const Vector<2>&)> place;
  Matrix<2> linear = Matrix<2>::Identity();  ///< of `place`, for what has a direction and no place
};

/// The same recording of the ground in another frame of reference: positions, velocities and covariances are changed, all else is
/// as it was. `recording` is used up track by track, so that memory holds it once. Throws Error where it is not of the ground in m.
Recording on_other_ground(Recording recording, const FrameOfReference& frame, const GroundChange& change);

}  // namespace marey
