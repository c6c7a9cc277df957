#pragma once

#include <string>
#include <vector>

#include "marey/core/rig.h"

#include "command_line.h"

namespace marey::cli {

/// The command line's `RIG [CAMERA=SOURCE …]`.
struct RigAndSources {
  std::string rig;
  std::vector<std::string> sources;
};

/// Both positionals. The rig's own sources and detections count as inputs too, where they are files.
Option add_rig(Command& command, RigAndSources& inputs, const std::string& meaning);

/// The rig that they name, its cameras' sources replaced. Throws Error.
Rig rig_of(const RigAndSources& inputs);

/// The sources and detections of a rig file's cameras; none where the rig is not a file.
std::vector<std::string> files_of_rig(const std::string& rig);

/// The command line's `[RIG] [CAMERA=SOURCE …] [--observations FILE|FOLDER]`.
struct RigInputs {
  RigAndSources rig;
  std::string observations;
};

Option add_rig_inputs(Command& command, RigInputs& inputs);

/// The rig that they name; of observations alone the rig that these name. Throws Error.
Rig rig_of(const RigInputs& inputs);

/// Where the observations come from: those that are named, else a take's own; empty for the cameras' sources.
std::string observations_of(const RigInputs& inputs);

}  // namespace marey::cli
