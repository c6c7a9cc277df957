#pragma once

#include <cstdint>

#include "marey/core/rig.h"
#include "marey/geometry/pitch.h"

namespace marey::simulate::match {

/// The same cameras known by ground homographies alone, each off by smooth errors as clicks at one end of the pitch and a bent lens
/// leave them: `least` to `most` m, root mean square over what the camera sees of the pitch. World and pitch must be the same.
Rig known_by_homographies(const Rig& exact, const geometry::PitchSize& pitch, double minimum, double maximum, std::uint64_t seed);

}  // namespace marey::simulate::match
