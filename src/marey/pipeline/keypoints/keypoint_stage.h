// A stage that reports boxes in the images of one camera, and with each sample the keypoints of who is in it.
#pragma once

#include <memory>

#include "marey/pipeline/corridor/run.h"
#include "marey/pipeline/keypoints/body_keypoints.h"

namespace marey::pipeline::keypoints {

/// `stage` is of this feed. Where it is not `live`, it reports its instants when the images are gone, so the feed is read once
/// more. Throws Error if the feed has no images, cannot be read twice, or the network is not usable.
std::unique_ptr<corridor::Stage> with_keypoints(std::unique_ptr<corridor::Stage> stage, const corridor::Feed& feed,
                                                const KeypointOptions& options, bool live);

}  // namespace marey::pipeline::keypoints
