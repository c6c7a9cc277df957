// The simulator as live cameras: sim://room, a room full of them around markers, and sim://people, one camera before walking
// people.
#pragma once

#include "marey/source/live/kinds.h"

namespace marey::pipeline::simulate {

/// A row of the register. Cameras of one room that it opens share the room: they see the same at the same time.
source::live::Kind simulation_kind();

}  // namespace marey::pipeline::simulate
