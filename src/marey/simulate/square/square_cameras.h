#pragma once

#include <cstdint>

#include "marey/core/rig.h"
#include "marey/simulate/square/square_motion.h"

namespace marey::simulate::square {

/// Cameras on posts round a square, 2 to 4 m up, that face across it, each at a part: "cam1", … The world's x and y are the
/// square's. 1 to 64 cameras; exact, 1920 × 1080.
Rig square_cameras(int cameras, double rate_hz, const SquareOptions& square, std::uint64_t seed);

}  // namespace marey::simulate::square
