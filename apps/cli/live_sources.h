#pragma once

#include <string>
#include <vector>

#include "marey/core/rig.h"

#include "command_line.h"

namespace marey::cli {

/// SOURCES: a rig file with CAMERA=SOURCE after it, or live sources alone.
void add_live_sources(Command& command, std::vector<std::string>& sources);

/// Whether this source is a rig file.
bool is_rig_file(const std::string& source);

/// The cameras that they name.
Rig rig_of_live_sources(const std::vector<std::string>& sources);

}  // namespace marey::cli
