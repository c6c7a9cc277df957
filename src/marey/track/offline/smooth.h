#pragma once

#include "marey/track/offline/tracklet_log.h"

namespace marey::track::offline {

struct Smoothing {
  double location = 0.12;  ///< standard deviation of the kernel over time that smooths places, s
  double size = 0.4;       ///< the same for sizes
  double velocity = 0.12;  ///< the same for velocities
};

/// Replaces places, sizes, velocities and the centres of outlines by local straight-line fits under a Gaussian kernel that reaches
/// both ways, so that nothing lags. Observed rows weigh more than predicted ones.
void smooth(TrackletLog::Tracklet& rows, const TrackletLog& log, const Smoothing& smoothing);

}  // namespace marey::track::offline
