#pragma once

#include "marey/track/tracklet_log.h"

namespace marey::track {

struct Smoothing {
  double place = 0.12;  ///< standard deviation of the kernel over time, s
  double size = 0.4;
};

/// Rows between two observed ones are put on the straight way between them, as predicted, where that lasts at most `longest`
/// seconds; where it lasts longer they are left out. `rows` are one target's, in the order of frames; frames may be missing.
void fill_gaps(TrackletLog::Tracklet& rows, const TrackletLog& log, double longest);

/// Replaces places, sizes, velocities and the centres of outlines by local straight-line fits under a Gaussian kernel that looks
/// both ways, so that nothing lags. Observed rows weigh more than predicted ones.
void smooth(TrackletLog::Tracklet& rows, const TrackletLog& log, const Smoothing& smoothing);

}  // namespace marey::track
