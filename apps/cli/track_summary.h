#pragma once

#include "marey/pipeline/track_markers.h"
#include "marey/pipeline/track_people.h"

namespace marey::cli {

/// On standard output. `elapsed` in s.
void print_json(const pipeline::TrackSummary& summary, const pipeline::TrackOutput& output, double elapsed);
void print_json(const pipeline::MarkerSummary& summary, const pipeline::TrackOutput& output, double elapsed);

/// On standard error, so that tracks may go to standard output.
void print_summary(const pipeline::TrackSummary& summary, const pipeline::TrackOutput& output, double elapsed);
void print_summary(const pipeline::MarkerSummary& summary, const pipeline::TrackOutput& output, double elapsed);

}  // namespace marey::cli
