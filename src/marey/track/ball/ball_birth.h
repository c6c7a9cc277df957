// How a hypothesis begins: something is seen, and nothing was known of the ball.
#pragma once

#include <memory>
#include <vector>

#include "marey/track/ball/ball_search.h"

namespace marey::track::ball {

/// How densely false things are seen where this one is, the logarithm of 1/px².
double false_density(const BallSighting& sighting, const BallView& view, const GroundView& ground,
                     const BallSearchOptions& options);

/// Adds to `out` what begins at an instant: a ball on the ground or in the air where one camera sees something away from people, or
/// where the rays of two meet.
void initiate(const std::shared_ptr<BallNode>& before, const BallObservations& time_step, const GroundViews& views,
              const BallSearchOptions& options, std::vector<BallNode>& out);

}  // namespace marey::track::ball
