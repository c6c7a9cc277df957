// How far a walk's markers can be trusted: where they are missing, and how steady distances within segments are.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/pipeline/bodies/gait_markers.h"

namespace marey::pipeline::bodies {

struct GaitQuality {
  struct Gaps {
    std::string marker;
    double missing_fraction = 0;  ///< of the recording's instants
    double longest_s = 0;         ///< the longest span in which it is missing
  };
  /// Two markers of one segment: skin moves over bone by some millimetres, a swapped or moved marker shows as more.
  struct Pair {
    std::string first, second;
    double distance_m = 0;              ///< median over the walk
    double range_m = 0;                 ///< between the 5th and the 95th percentile
    std::optional<double> to_static_m;  ///< the walk's median less the static trial's distance
  };

  std::size_t markers = 0;          ///< of the set that are in the recording
  std::vector<std::string> absent;  ///< of the set that never are
  std::vector<Gaps> gaps;           ///< of markers that are missing at some time
  std::vector<Pair> pairs;          ///< the least steady first
};

/// `standing` may be empty.
GaitQuality gait_quality(const GaitMarkers& walk, const gait::MarkerPositions& standing);

}  // namespace marey::pipeline::bodies
