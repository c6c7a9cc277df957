#pragma once

#include "marey/core/keypoints.h"

namespace marey::detect::keypoints {

/// The 33 points of MediaPipe's landmark networks, in their order; left and right are the person's own.
const KeypointSet& blazepose();

}  // namespace marey::detect::keypoints
