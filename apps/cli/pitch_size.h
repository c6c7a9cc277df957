#pragma once

#include <string>

#include "marey/geometry/pitch.h"

namespace marey::cli {

/// LENGTHxWIDTH in m. Throws WrongUsage for what is none, or no pitch.
geometry::PitchSize parse_pitch_size(const std::string& text);

}  // namespace marey::cli
