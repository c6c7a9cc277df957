#pragma once

#include "marey/pipeline/people/ground/track_ground.h"

namespace marey::cli {

/// On standard output. `elapsed` in s.
void print_json(const pipeline::people::ground::GroundSummary& summary, const pipeline::people::ground::GroundOutput& output,
                double elapsed);

/// On standard error, so that tracks may go to standard output.
void print_summary(const pipeline::people::ground::GroundSummary& summary, const pipeline::people::ground::GroundOutput& output,
                   double elapsed);

}  // namespace marey::cli
