#pragma once

#include <functional>
#include <string>
#include <vector>

#include "marey/calibrate/wand/wand.h"
#include "marey/core/hooks.h"
#include "marey/detect/markers/marker_detector.h"
#include "marey/pipeline/calibrate/live_observed.h"
#include "marey/pipeline/live/camera_settings.h"

namespace marey::pipeline::calibrate {

/// Whether every camera's lens is given: else more of the wand is wanted.
bool knows_lenses(const Rig& rig);

struct CalibrateWandOptions {
  std::string observations;  ///< what another program saw of the wand; empty: it is searched for in the cameras' sources
  detect::markers::MarkerOptions markers;
  marey::calibrate::MarkerLine wand;
  marey::calibrate::wand::WandOptions how;  ///< offsets are searched for unless `synced`, or the cameras' rate is not given
  bool synced = false;                      ///< the cameras' clocks are right
  live::CameraSettings* camera_settings =
      nullptr;          ///< live cameras: by which they are set while the wand is waved, and the rig that is found too
  double wave_s = 600;  ///< live cameras: the wand is waved until it was seen enough, at most this long
  /// Ten times a second while it is waved; false: the observations suffice. May be empty.
  std::function<bool(const LiveObserved& detected)> waving = {};
  /// It has been waved: the rest is computed. May be empty.
  std::function<void()> waved = {};
};

struct WandCalibration {
  marey::calibrate::wand::WandResult found;
  std::vector<std::string> warnings;  ///< of the cameras' sources, one sentence each
};

/// Where the rig's cameras stand, by a wand or a light waved before them: in videos, or before live cameras now. Throws Error if
/// a source cannot be read, and as calibrate::wand::calibrate_wand does; Stopped.
WandCalibration calibrate_wand(const Rig& rig, const CalibrateWandOptions& options, const Hooks& hooks = {});

}  // namespace marey::pipeline::calibrate
