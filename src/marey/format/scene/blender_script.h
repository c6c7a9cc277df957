#pragma once

#include <string_view>

namespace marey::format::scene {

/// What follows the data in a scene for Blender: Python, for Blender 4.2 and later.
extern const std::string_view kBlenderScript;

}  // namespace marey::format::scene
