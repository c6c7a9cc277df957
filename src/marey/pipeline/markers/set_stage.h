// A stage that reports points in space, with a learned set's names within the frame.
#pragma once

#include <memory>

#include "marey/core/learned_markers.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/pipeline/markers/set_in_space.h"

namespace marey::pipeline::markers {

/// Throws Error if the set has fewer than four markers.
std::unique_ptr<corridor::Stage> with_set(std::unique_ptr<corridor::Stage> stage, std::shared_ptr<const LearnedMarkers> set,
                                          const SetInSpaceOptions& options);

}  // namespace marey::pipeline::markers
