// A stage that tells boxes in the pictures of one camera, and with each sample the keypoints of who is in it.
#pragma once

#include <memory>

#include "marey/pipeline/body_keypoints.h"
#include "marey/pipeline/run.h"

namespace marey::pipeline {

/// `stage` is of this feed. Where it is not `live`, it tells its instants when the pictures are gone, so the feed is read once
/// more. Throws Error where the feed has no pictures, cannot be read twice, or the network is not usable.
std::unique_ptr<Stage> with_keypoints(std::unique_ptr<Stage> stage, const Feed& feed, const KeypointOptions& options, bool live);

}  // namespace marey::pipeline
