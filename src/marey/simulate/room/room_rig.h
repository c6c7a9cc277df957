#pragma once

#include "marey/core/rig.h"
#include "marey/simulate/room/room.h"

namespace marey::simulate::room {

/// The cameras of a simulated room: evenly round the volume, by turns high and lower, each facing its middle, each a little
/// different from the others as the seed says.
Rig room_rig(const RoomOptions& options);

/// The same after a person ran into the camera of `options.bump`.
Rig bumped(const Rig& rig, const RoomOptions& options);

}  // namespace marey::simulate::room
