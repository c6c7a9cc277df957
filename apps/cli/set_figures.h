#pragma once

#include "marey/pipeline/corridor/run.h"

#include "json_value.h"

namespace marey::cli {

/// How many points have the set's names, where one was given: "set" of the JSON, a line on standard error.
void add_set_figures(const pipeline::corridor::Summary& summary, Json& json);
void print_set_figures(const pipeline::corridor::Summary& summary);

}  // namespace marey::cli
