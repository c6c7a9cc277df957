#pragma once

#include "marey/track/ground/ground_tracker.h"

namespace marey::track::ground {

/// Follows people on the ground by global nearest neighbour: in each view the one assignment of greatest likelihood.
std::unique_ptr<GroundTracker> make_ground_gnn(const GroundTrackerOptions& options, std::shared_ptr<const GroundViews> views);

}  // namespace marey::track::ground
