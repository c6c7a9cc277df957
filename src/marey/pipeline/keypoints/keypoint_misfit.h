#pragma once

#include <string>
#include <vector>

#include "marey/core/keypoints.h"
#include "marey/core/rig.h"
#include "marey/pipeline/keypoints/keypoint_frames.h"

namespace marey::pipeline::keypoints {

/// Where keypoints of several cameras do not meet: what would make them meet, one sentence each. Tried are two cameras exchanged,
/// and one camera's images mirrored.
std::vector<std::string> reasons_of_misfit(const Rig& rig, const KeypointFrames& frames, const KeypointSet& set);

}  // namespace marey::pipeline::keypoints
