#pragma once

#include "marey/track/ground/ground_tracker.h"

namespace marey::track::ground {

/// Follows people on the ground by joint probabilistic data association: each target is corrected by all observations in its gate,
/// weighed by their probabilities.
std::unique_ptr<GroundTracker> make_ground_jpda(const GroundTrackerOptions& options, std::shared_ptr<const GroundViews> views);

}  // namespace marey::track::ground
