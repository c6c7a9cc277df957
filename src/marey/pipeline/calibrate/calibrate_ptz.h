// From a video of a main camera that pans, tilts and zooms, and clicks in a few of its frames, to a rig whose camera turns.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/calibrate/ptz/ptz_tracker.h"
#include "marey/core/hooks.h"
#include "marey/core/rig.h"

namespace marey::pipeline::calibrate {

enum class PtzSide { near, far };

struct PtzRunOptions {
  marey::calibrate::ptz::TrackingOptions tracking;  ///< its pitch is the one clicked on
  std::string name = "main";                        ///< of the camera, in the rig
  std::string overlay;                              ///< a video with the pitch drawn into every frame; empty for none
  /// Without clicks: behind which touchline the camera stands, y = 0 or the far one; both fit alike. Nothing: near, and a
  /// warning that says so.
  std::optional<PtzSide> side;
  double odd_click = 6;            ///< deviations of a click, or medians of all clicks: one that lies farther off is named
  double start_agrees = 2;         ///< m: without clicks, the track may be so far off a frame of the start,
  double starts_that_agree = 0.6;  ///< and this share of them has to agree
};

struct PtzRun {
  Rig rig;                                                  ///< one camera, which turns as `result` says
  std::vector<marey::calibrate::ptz::ClickedFrame> clicks;  ///< as they are in the file; without clicks the frames of the start
  marey::calibrate::ptz::ClickedTripod clicked;             ///< the tripod by them alone
  bool searched = false;                                    ///< no clicks were given
  marey::calibrate::ptz::PtzResult result;
  std::vector<std::string> warnings;  ///< one sentence each
  double seconds = 0;                 ///< that following took, reading the video included
};

/// Calibrates the camera of a video by a file of clicks that says the frame of each (`read_pitch_clicks`); with an empty name, by
/// the lines of its images alone (start_ptz.h). Throws Error if a file cannot be read, the clicks do not decide, and where barely
/// a frame shows the lines of the pitch that was clicked; without clicks where the images do not decide, with the frame to click;
/// Stopped.
PtzRun calibrate_ptz(const std::string& video, const std::string& clicks, const PtzRunOptions& options = {},
                     const Hooks& hooks = {});

}  // namespace marey::pipeline::calibrate
