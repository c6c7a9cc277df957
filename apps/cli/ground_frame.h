#pragma once

#include <string>
#include <vector>

#include "marey/core/geometry.h"

#include "command_line.h"

namespace marey::cli {

inline constexpr const char* kDefaultGroundFrame = "0,0;0.2,0;0.6,0;0,0.4";

/// --l-frame of an L-frame on the floor, checked.
Option add_ground_frame(Command& command, std::string& text, const std::string& meaning);

/// Its markers, m, on the ground.
std::vector<Vector<3>> ground_frame_of(const std::string& text);

}  // namespace marey::cli
