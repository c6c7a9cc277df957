// A recording as a whole decides how its limbs are bent. Frame by frame a limb may come into another fold than the one it is in (an
// elbow bent backwards with the upper arm turned about itself), and stay there, for few markers barely distinguish the two in one
// frame; over a recording they do.
//
// Two sources of other motions: the recording solved from its end to its beginning, and limbs turned about where that fits better,
// followed both ways from there until they meet the solution. Over the frames in which two motions differ, the one whose markers,
// limits and folds cost less in sum is taken.
#pragma once

#include <span>
#include <vector>

#include "marey/core/skeleton.h"
#include "marey/solve/skeleton/calibrate.h"
#include "marey/solve/skeleton/pose_solver.h"

namespace marey::solve::skeleton {

/// `rows` are the coordinates of a first pass, one for each of `frames`, at an even rate: where others fit better they are
/// replaced. Says for each frame whether it was.
std::vector<bool> settle_folds(const Skeleton& skeleton, std::span<std::vector<double>> rows,
                               std::span<const ObservedMarkers> frames, double rate_hz, const PoseOptions& options = {});

}  // namespace marey::solve::skeleton
