#pragma once

#include "marey/pipeline/people/track_in_image.h"

namespace marey::cli {

/// On standard output. `elapsed` in s.
void print_json(const pipeline::corridor::Summary& summary, const pipeline::people::TrackOutput& output, bool markers,
                double elapsed);

/// On standard error, so that tracks may go to standard output.
void print_summary(const pipeline::corridor::Summary& summary, const pipeline::people::TrackOutput& output, bool markers,
                   double elapsed);

}  // namespace marey::cli
