#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include <string>

namespace marey::pipeline {


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
