#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/geometry/pitch.h"

namespace marey::pipeline::jobs {

/// LENGTHxWIDTH in m. Throws WrongOption for what is not one, or no pitch.
geometry::PitchSize parse_pitch_size(const std::string& text);

/// A part of the ground: LENGTHxWIDTH in m, a rectangle from the origin on, or its corners, "x,y x,y x,y …". Throws WrongOption.
std::vector<Vector<2>> parse_area(const std::string& text);

/// LENGTHxWIDTH of a pitch, or of any rectangle: then there is no pitch.
std::optional<geometry::PitchSize> parse_pitch_or_rectangle(const std::string& text);

}  // namespace marey::pipeline::jobs
