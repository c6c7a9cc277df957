#pragma once

#include <functional>

#include "marey/core/recording.h"

namespace marey {

/// How places on the ground of one frame of reference are reported in another; affine, m to m.
struct GroundChange {
  std::function<Vector<2>(const Vector<2>&)> location;
  Matrix<2> linear = Matrix<2>::Identity();  ///< of `place`, for what has a direction and no place
};

/// The same recording of the ground in another frame of reference: positions, velocities and covariances are changed, all else is
/// as it was. `recording` is used up track by track, so that memory holds it once. Throws Error if it is not of the ground in m.
Recording on_other_ground(Recording recording, const FrameOfReference& frame, const GroundChange& change);

// Which side of the ground is up. Every drawing of it from above (viewer, pitch view, report, map) has x to the right and asks
// here whether y grows downwards, so that a corner of the pitch is the same corner in all of them.

/// Whether it makes the right-handed world left-handed: seen from above, y is to the right of x.
bool is_reflection(const Matrix<3>& ground_from_world);
/// Whether the recording's y grows downwards: its frame is the user's, and by its rig a reflection of the world.
bool y_grows_down(const RecordingHeader& header);
/// Notes in a header what its file states of it, where no rig does: its world is then its own frame, turned over if `down`.
void set_y_down(RecordingHeader& header, bool down);

}  // namespace marey
