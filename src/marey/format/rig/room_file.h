#pragma once

#include <string>
#include <string_view>

#include "marey/core/planned_room.h"

namespace marey::format::rig {

/// Reads a room.toml (docs/plan.md). Throws Error with every problem of the file, one line each, `path:LINE: what; what to do`.
PlannedRoom read_room(const std::string& path);

/// The same from text, which messages call `name`.
PlannedRoom parse_room(std::string_view text, const std::string& name);

}  // namespace marey::format::rig
