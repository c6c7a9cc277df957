#pragma once

#include <map>
#include <string>
#include <vector>

#include "marey/calibrate/pitch/pitch.h"
#include "marey/core/rig.h"
#include "marey/pipeline/people/ground/ground_offsets.h"

namespace marey::pipeline::calibrate {

struct PitchRun {
  Rig rig;                                                ///< the given one, with lenses, poses and `ground_from_world` found
  std::vector<std::string> cameras;                       ///< those calibrated, in the rig's order
  std::vector<marey::calibrate::pitch::PitchView> views;  ///< one for each: what it was calibrated from
  marey::calibrate::pitch::PitchCalibration calibration;  ///< one view for each
  std::vector<std::string> warnings;                      ///< one sentence each
  people::ground::RigOffsets offsets;                     ///< empty if the rig says all of them, or too few cameras see people
};

struct PitchRunOptions {
  marey::calibrate::pitch::PitchCalibrationOptions pitch;  ///< a ground known wholly is the rig's
  bool synced = false;                                     ///< the cameras run on one clock: those without an offset have 0
  std::string images;                                      ///< a folder for overlays and the accuracy maps; empty for none
};

/// What is drawn of one camera into a folder: the pitch over its image, and a map of what a pixel is on the ground.
struct PitchImages {
  std::string overlay, accuracy;

  PitchImages(const std::string& folder, const std::string& camera);
};

/// Calibrates the rig's cameras over a pitch, all over one ground, which is the rig's where others of its cameras were calibrated
/// over that already: for each camera a file of clicks (`read_pitch_clicks`), by the camera's name. Where
/// the camera has images, the empty ground is learned from them and its white lines refine what the clicks began. Where the rig
/// does not specify when cameras were started, that is found from how people move (`find_rig_offsets`). Throws Error
/// where a file cannot be read, a camera is not in the rig, or the clicks do not decide; Stopped.
PitchRun calibrate_pitch(const Rig& rig, const std::map<std::string, std::string>& clicks, const PitchRunOptions& options = {},
                         const Hooks& hooks = {});

}  // namespace marey::pipeline::calibrate
