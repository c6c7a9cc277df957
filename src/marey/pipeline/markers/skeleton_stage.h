// A stage that reports points in space, and with each instant the pose of a skeleton whose markers are among them.
#pragma once

#include <memory>

#include "marey/core/skeleton.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/solve/skeleton/pose_solver.h"

namespace marey::pipeline::markers {

/// Throws Error if the skeleton has no markers or nothing that moves.
std::unique_ptr<corridor::Stage> with_skeleton(std::unique_ptr<corridor::Stage> stage, std::shared_ptr<const Skeleton> skeleton,
                                               const solve::skeleton::PoseOptions& options);

}  // namespace marey::pipeline::markers
