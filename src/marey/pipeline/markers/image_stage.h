// Bright, dark or coloured markers in the images of one camera, under the names that they have in the first frame.
#pragma once

#include <memory>
#include <optional>

#include "marey/detect/markers/marker_detector.h"
#include "marey/pipeline/corridor/marker_tuning.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/track/roster/roster_tracker.h"

namespace marey::pipeline::markers {

struct ImageMarkerOptions {
  detect::markers::MarkerOptions markers;
  track::roster::RosterTrackerOptions tracker;
  bool fit_noise = false;  ///< read the filter's noise off the beginning of the recording; not where `live`
  /// Every frame's markers are reported as they come, and nothing is improved by what came later.
  bool live = false;
  std::shared_ptr<corridor::MarkerTuning> tuning = {};  ///< how the detector is changed while it runs; null: it stays as it is
};

/// After the last frame (not where `live`) false points are dropped, parts known to be gone are cut, and gaps are filled from both
/// ends. Memory grows with the rows, 64 bytes each.
std::unique_ptr<corridor::Stage> markers_in_image(const corridor::Feed& feed, const ImageMarkerOptions& options);

}  // namespace marey::pipeline::markers
