#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "marey/format/tracks/track_file.h"

namespace marey::pipeline {

/// Where the results of a run go.
struct TrackOutput {
  std::string tracks;
  format::tracks::TrackFormat format = format::tracks::TrackFormat::mot;
  std::string overlay = {};  ///< a film with the tracks drawn into the pictures; empty for none
  std::string plot = {};     ///< an SVG picture of the ways that were gone, in the coordinates of the image; empty for none
};

struct TrackProgress {
  enum class Step { clocks, tracking, drawing };  ///< `clocks`: finding when cameras were started
  Step step = Step::tracking;
  std::int64_t done = 0;              ///< frames
  std::optional<std::int64_t> total;  ///< where it is known
};

/// How a run talks to whoever started it; both may be empty. Called between frames, on the thread that started the run.
struct RunHooks {
  std::function<void(const TrackProgress&)> progress;
  std::function<bool()> stop;  ///< true: leave off here, and write what there is

  /// Tells how far the run is; whether it is to stop.
  bool tell(const TrackProgress& now) const {
    if (progress) progress(now);
    return stop && stop();
  }
};

}  // namespace marey::pipeline
