#pragma once

#include "marey/track/ground/ground_tracker.h"
#include "marey/track/ground/mht/ground_hypotheses.h"

namespace marey::track::ground::mht {

/// What multiple-hypothesis tracking keeps beyond GroundTrackerOptions.
struct GroundMhtLimits {
  double ratio = 1e-4;          ///< a hypothesis less likely than the best of its cluster by more than this factor is dropped
  int leaves = 2000;            ///< of all hypotheses of a cluster, counted once for each: a large cluster keeps fewer hypotheses
  bool fold = true;             ///< make one of hypotheses that have come to the same
  bool distrust_shared = true;  ///< trust less of an observation that may be of two who touch
};

/// Follows people on the ground by multiple-hypothesis tracking (ground_mht.cpp).
std::unique_ptr<GroundTracker> make_ground_mht(const GroundTrackerOptions& options, std::shared_ptr<const GroundViews> views,
                                               const GroundMhtLimits& limits = {});

}  // namespace marey::track::ground::mht
