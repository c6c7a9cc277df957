// People on the ground by BraMBLe (track/bramble): particles over who is where explain what the images show, without detections
// or data association. A stage of its own, so that no other knows of it.
#pragma once

#include <memory>
#include <vector>

#include "marey/pipeline/people/ground/people_on_ground.h"

namespace marey::pipeline::people::ground {

/// As `people_on_ground`, with `options.bramble`; detector, tracker, learned models and teams do not count. Throws Error if a
/// camera has no images, is not calibrated, or is a PTZ camera.
std::unique_ptr<PeopleOnGround> bramble_on_ground(const std::vector<corridor::Feed>& feeds, const Rig& rig,
                                                  const PeopleOnGroundOptions& options);

}  // namespace marey::pipeline::people::ground
