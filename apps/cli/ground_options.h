#pragma once

#include <optional>
#include <string>

#include "marey/core/rig.h"
#include "marey/pipeline/people/people_on_ground.h"

#include "command_line.h"

namespace marey::cli {

/// Where people on the ground count, and how they are associated: the same options and defaults in `marey track --ground` and
/// `marey live --ground`.
struct GroundAreaFlags {
  std::string size, area;
  std::optional<double> margin;
  std::string teams;
  std::string association;
};

/// Adds --size, --area, --margin, --teams and --associate, each of which needs the option `ground`.
void add_ground_area_options(Command& command, const Option& ground, GroundAreaFlags& flags);

/// Sets pitch, area, margin, teams, association and `live` of `options`, and what depends on them (pipeline::resolved).
/// `filter_chosen`: `tracker.filter` is what --filter asked for. `rig_name` is for messages. Throws WrongUsage for --margin
/// without an area.
void apply(const GroundAreaFlags& flags, const Rig& rig, const std::string& rig_name, bool live, bool filter_chosen,
           pipeline::people::PeopleOnGroundOptions& options);

}  // namespace marey::cli
