#pragma once

#include <vector>

#include "marey/track/tracklet_log.h"

namespace marey::track {

struct GapOptions {
  double longest_filled = 1;  ///< s; in a longer gap nothing is said of where the target was
};

/// What a second look can say of points that were followed by themselves: nothing is reported before the first and after the last
/// observation of a tracklet, and in a gap between two the place is the cubic through the places and velocities at both ends,
/// instead of a guess that knows the first end alone. Tracklets seen in less than `fewest` frames are dropped. Rows in the order of
/// frames, then ids. The recording's tracklets are used up.
std::vector<TrackRow> fill_gaps(TrackletLog& log, const GapOptions& options = {}, int fewest = 3);

}  // namespace marey::track
