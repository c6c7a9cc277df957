#pragma once

#include <cstdint>
#include <string_view>

#include "marey/pipeline/corridor/run.h"

#include "json_value.h"

// Figures that the summaries of several commands share.
namespace marey::cli {

/// 0 where the run did not find it out.
double figure_of(const pipeline::corridor::Summary& summary, std::string_view name);
/// How many were omitted for this reason.
std::int64_t excluded_of(const pipeline::corridor::Summary& summary, std::string_view reason);
/// In per cent; 0 of nothing.
double percent_of(std::int64_t part, std::int64_t whole);

/// How well a skeleton that was solved with every instant fits, where there was one: "skeleton" of the JSON, a line on standard
/// error.
void add_skeleton_figures(const pipeline::corridor::Summary& summary, Json& json);
void print_skeleton_figures(const pipeline::corridor::Summary& summary);

/// How long each step took: its name → count, median and 99 %, in ms; null where no step was measured.
Json stages_of(const pipeline::corridor::Summary& summary);
/// The same, a line each on standard error.
void print_stages(const pipeline::corridor::Summary& summary);

}  // namespace marey::cli
