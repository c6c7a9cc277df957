#pragma once

#include <optional>
#include <string>

#include "marey/calibrate/wand/wand.h"

namespace marey::cli {

/// "CAM1,CAM2=METRES"; nothing for an empty text. Throws WrongUsage.
std::optional<calibrate::wand::KnownDistance> distance_of(const std::string& text);

}  // namespace marey::cli
