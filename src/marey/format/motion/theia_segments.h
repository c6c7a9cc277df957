// The segments of Theia3D's C3D files as a skeleton. A file has a matrix of 4x4 for each segment and says neither which hangs on
// which nor how long they are: the first follows from Theia's names, the second from the motion. Segments' axes are parallel when a
// person stands upright with arms down (x to the right, y ahead, z up), which is the skeleton's rest.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "marey/core/body.h"

namespace marey::format::motion {

/// A body's pose in a frame; nothing if it is not known there. Frames count from 0, bodies by their order.
using PoseInFrame = std::function<std::optional<Rigid3>(std::size_t frame, std::size_t body)>;

/// Hangs the bodies that are Theia's segments on each other, parents first, with the median offset over the frames. False, and
/// nothing is changed, if pelvis, thighs and shanks of both sides are not all there. Bodies of other names stay by themselves.
/// The order stays, if parents come before children.
bool hang_theia_segments(std::vector<Body>& bodies, std::size_t frames, const PoseInFrame& pose);

}  // namespace marey::format::motion
