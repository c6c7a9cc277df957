// Force plates in a take: a table beside those of its recording, which readers that do not know it pass over (docs/take.md).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "marey/core/force_plate.h"

namespace marey::format::take {

/// Adds plates to a finished take, in place of those that it has. Loads are kept as floats. Throws Error if it cannot be written.
void write_plates(const std::string& path, std::span<const ForcePlate> plates);

/// None if the take has none. Throws Error if it is not a take, or they are damaged.
std::vector<ForcePlate> read_plates(const std::string& path);

}  // namespace marey::format::take
