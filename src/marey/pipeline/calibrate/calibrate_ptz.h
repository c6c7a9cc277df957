// From a video of a main camera that pans, tilts and zooms, and clicks in a few of its frames, to a rig whose camera turns.
#pragma once

#include <string>
#include <vector>

#include "marey/calibrate/ptz/ptz_tracker.h"
#include "marey/core/hooks.h"
#include "marey/core/rig.h"

namespace marey::pipeline::calibrate {

struct PtzRunOptions {
  marey::calibrate::ptz::TrackingOptions tracking;  ///< its pitch is the one clicked on
  std::string name = "main";                        ///< of the camera, in the rig
  std::string overlay;                              ///< a video with the pitch drawn into every frame; empty for none
};

struct PtzRun {
  Rig rig;                                                  ///< one camera, which turns as `result` says
  std::vector<marey::calibrate::ptz::ClickedFrame> clicks;  ///< as they are in the file
  marey::calibrate::ptz::ClickedTripod clicked;             ///< the tripod by them alone
  marey::calibrate::ptz::PtzResult result;
  std::vector<std::string> warnings;  ///< one sentence each
  double seconds = 0;                 ///< that following took, reading the video included
};

/// Calibrates the camera of a video by a file of clicks that says the frame of each (`read_pitch_clicks`). Throws Error if a file
/// cannot be read, the clicks do not decide, and where barely a frame shows the lines of the pitch that was clicked; Stopped.
PtzRun calibrate_ptz(const std::string& video, const std::string& clicks, const PtzRunOptions& options = {},
                     const Hooks& hooks = {});

}  // namespace marey::pipeline::calibrate
