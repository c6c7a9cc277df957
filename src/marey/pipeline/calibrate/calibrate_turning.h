// From a film of a main camera that pans, tilts and zooms, and clicks in a few of its frames, to a rig whose camera turns.
#pragma once

#include <string>
#include <vector>

#include "marey/calibrate/turning/follow.h"
#include "marey/core/hooks.h"
#include "marey/core/rig.h"

namespace marey::pipeline::calibrate {

struct TurningRunOptions {
  marey::calibrate::turning::FollowOptions follow;  ///< its pitch is the one clicked on
  std::string name = "main";                        ///< of the camera, in the rig
  std::string overlay;                              ///< a film with the pitch drawn into every frame; empty for none
};

struct TurningRun {
  Rig rig;                                                      ///< one camera, which turns as `result` says
  std::vector<marey::calibrate::turning::ClickedFrame> clicks;  ///< as they are in the file
  marey::calibrate::turning::ClickedTripod clicked;             ///< the tripod by them alone
  marey::calibrate::turning::TurningResult result;
  std::vector<std::string> warnings;  ///< one sentence each
  double seconds = 0;                 ///< that following took, reading the film included
};

/// Calibrates the camera of a film by a file of clicks that says the frame of each (`read_pitch_clicks`). Throws Error where a file
/// cannot be read, the clicks do not decide, and where hardly a frame shows the lines of the pitch that was clicked; Stopped.
TurningRun calibrate_turning(const std::string& film, const std::string& clicks, const TurningRunOptions& options = {},
                             const Hooks& hooks = {});

}  // namespace marey::pipeline::calibrate
