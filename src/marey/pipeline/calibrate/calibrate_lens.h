#pragma once

#include <optional>
#include <string>

#include "marey/calibrate/lens_calibration.h"
#include "marey/pipeline/calibrate/find_boards.h"

namespace marey::pipeline::calibrate {

struct LensRunOptions {
  marey::calibrate::LensOptions lens;
  std::size_t max_views = kViewsOfLens;  ///< images that the solution rests on
  std::optional<cv::Rect> region;
};

struct LensRun {
  marey::calibrate::LensCalibration calibration;
  std::int64_t frames = 0;  ///< searched for the board
  int sightings = 0;        ///< frames that show the board
};

/// Calibrates the lens that took `input`: a video, a folder of images or a pattern. Throws Error if the board is nowhere to be
/// seen, or where calibrate::calibrate_lens does; Stopped.
LensRun calibrate_lens(const std::string& input, const marey::calibrate::board::Board& board, const LensRunOptions& options,
                       const Hooks& hooks = {});

}  // namespace marey::pipeline::calibrate
