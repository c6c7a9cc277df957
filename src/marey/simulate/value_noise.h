#pragma once

#include <cstdint>

#include "marey/core/geometry.h"

namespace marey::simulate {

/// Smooth random values in [−1, 1] over the plane: random at the corners of a grid of whole numbers, mixed between them. The same
/// for the same seed.
double value_noise(const Vector<2>& at, std::uint64_t seed);

}  // namespace marey::simulate
