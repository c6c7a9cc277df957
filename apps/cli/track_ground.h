#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ground_options.h"
#include "people_options.h"

namespace marey::cli {

/// What `marey track RIG --ground` understands beyond what every target needs.
struct GroundFlags {
  bool ground = false;
  std::vector<std::string> sources;
  GroundAreaFlags where;
  std::string camera;
  std::string pitch_view;
  bool ball = false;
};

/// What it shares with tracking in one picture.
struct GroundCommand {
  std::string rig, out, format, overlay, filter;
  std::optional<double> rate_hz;
  bool live = false, quiet = false, json = false;
};

void add_ground_options(Command& command, GroundFlags& flags);

/// The files that are written although no option names them.
std::vector<std::string> ground_files(const GroundCommand& command, const GroundFlags& flags);

/// Follows people on the ground and reports what came of it. Throws Error.
void track_on_ground(const GroundCommand& command, const GroundFlags& flags, const PeopleFlags& people);

}  // namespace marey::cli
