// Where the camera of a video is aimed at the beginning, from its images alone: those of each minute that show most lines are
// searched together (calibrate/ptz/tripod_search.h), minute by minute until one gives the tripod.
#pragma once

#include <cstdint>
#include <optional>

#include "marey/calibrate/ptz/tripod_search.h"
#include "marey/core/hooks.h"
#include "marey/pipeline/corridor/feed.h"

namespace marey::pipeline::calibrate {

struct PtzStart {
  std::optional<marey::calibrate::ptz::SearchedTripod> found;  ///< nothing: the images do not decide
  bool ambiguous = false;                                      ///< in a minute two hypotheses explained them alike
  std::int64_t frame = 0;                                      ///< that shows most lines: the one to click
  int lines = 0;
};

/// Reads a feed of its own. Throws Error if it cannot be read; Stopped.
PtzStart start_of_video(const corridor::Feed& feed, const geometry::PitchSize& pitch,
                        const marey::calibrate::ptz::TripodSolveOptions& solve, const Hooks& hooks = {});

/// 8-bit luma with the colours beside it.
Image in_bytes(const Image& image);

}  // namespace marey::pipeline::calibrate
