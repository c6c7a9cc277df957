#pragma once

#include <string>
#include <vector>

#include "marey/calibrate/wand/wand.h"
#include "marey/core/hooks.h"
#include "marey/detect/markers/marker_detector.h"

namespace marey::pipeline {

struct CalibrateWandOptions {
  std::string observations;  ///< what another program saw of the wand; empty: it is looked for in the cameras' sources
  detect::markers::MarkerOptions markers;
  calibrate::wand::WandShape wand;
  calibrate::wand::WandOptions how;  ///< offsets are looked for unless `synced`, or nobody says the cameras' rate
  bool synced = false;               ///< the cameras' clocks are right
};

struct WandCalibration {
  calibrate::wand::WandResult found;
  std::vector<std::string> warnings;  ///< of the cameras' sources, one sentence each
};

/// Where the rig's cameras stand, by a wand or a light waved before them. Throws Error where a source cannot be read, and as
/// calibrate::wand::calibrate_wand does; Stopped.
WandCalibration calibrate_wand(const Rig& rig, const CalibrateWandOptions& options, const Hooks& hooks = {});

}  // namespace marey::pipeline
