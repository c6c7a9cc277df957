#pragma once

#include <string>
#include <vector>

#include "marey/pipeline/jobs/track_ground.h"

namespace marey::cli {

/// `marey track RIG --ground`.
struct GroundCommand {
  pipeline::jobs::TrackGround job;
  std::vector<std::string> sources;
  std::string rig, out, format;
  bool quiet = false, json = false;
};

/// The files that are written although no option names them.
std::vector<std::string> ground_files(const GroundCommand& command);

/// Tracks people on the ground and reports the summary. Throws Error.
void track_on_ground(GroundCommand command);

}  // namespace marey::cli
