#pragma once

#include <memory>
#include <string>

#include "marey/core/learned_markers.h"
#include "marey/core/skeleton.h"
#include "marey/pipeline/corridor/run.h"

#include "command_line.h"
#include "json_value.h"

namespace marey::cli {

/// --set of who names markers while they come.
void add_set_option(Command& command, std::string& set);

/// Null where none was named. Throws Error where the file is no set, or `skeleton` has none of its markers.
std::shared_ptr<const LearnedMarkers> learned_set_of(const std::string& path, const Skeleton* skeleton);

/// How many points bear the set's names, where one was given: "set" of the JSON, a line on standard error.
void add_set_figures(const pipeline::corridor::Summary& summary, Json& json);
void print_set_figures(const pipeline::corridor::Summary& summary);

}  // namespace marey::cli
