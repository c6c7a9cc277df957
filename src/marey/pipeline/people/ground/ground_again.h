#pragma once

#include <memory>
#include <vector>

#include "marey/pipeline/people/ground/people_on_ground.h"

namespace marey::pipeline::people::ground {

/// `people_on_ground` that processes its cameras a second time where a person who had been taken for a part of a scene since the
/// beginning has left it: with scenes in which they are not. Not where `live`, nor where a camera cannot be read twice; the summary
/// then says who came out of the background, and when.
std::unique_ptr<PeopleOnGround> people_on_ground_again(const std::vector<corridor::Feed>& feeds, const Rig& rig,
                                                       const PeopleOnGroundOptions& options);

}  // namespace marey::pipeline::people::ground
