#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/detect/markers/marker_detector.h"
#include "marey/filter/fit_noise.h"
#include "marey/pipeline/run.h"
#include "marey/track/roster_tracker.h"

namespace marey::pipeline {

struct TrackMarkersOptions {
  detect::markers::MarkerOptions markers;
  track::RosterTrackerOptions tracker;
  bool fit_noise = false;  ///< read the filter's noise off the beginning of the recording
  /// Every frame's markers are written as they come, and nothing is improved by what came later.
  bool live = false;
};

struct MarkerSummary {
  std::int64_t frames = 0;
  double seconds = 0;                     ///< from the first frame to the last
  std::int64_t markers = 0;               ///< distinct names
  std::int64_t rows = 0;                  ///< markers times the frames they are in
  std::int64_t detections = 0;            ///< handed to the tracker
  std::optional<filter::NoiseFit> noise;  ///< where it was asked for and could be told
  bool stopped = false;                   ///< before the end, because a hook said so
  std::vector<std::string> warnings;      ///< what went wrong without stopping the run, one sentence each
};

/// Follows markers through a recording (whatever open_source opens) under the names they have in the first frame, and writes where
/// they were. After the last frame (not where `live`) false points are dropped, what is known to be gone is cut, and gaps
/// are filled from both ends. Memory grows with the rows, 64 bytes each.
/// Throws Error where the input cannot be read at all, labels do not fit, or an output cannot be written.
MarkerSummary track_markers(const std::string& pictures, std::optional<double> rate_hz, const TrackOutput& output,
                            const TrackMarkersOptions& options = {}, const RunHooks& hooks = {});

/// Names from a text file, one a line; blank lines do not count. Throws Error where it cannot be read, holds no name, or one twice.
std::vector<std::string> read_labels(const std::string& path);

/// A mask for MarkerOptions from a picture file: what is brighter than black is left out. Throws Error where it cannot be read.
cv::Mat read_mask(const std::string& path);

}  // namespace marey::pipeline
