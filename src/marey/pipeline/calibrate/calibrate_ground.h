#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/calibrate/board/board.h"
#include "marey/calibrate/ground.h"
#include "marey/core/hooks.h"
#include "marey/core/rig.h"
#include "marey/detect/markers/marker_detector.h"

namespace marey::pipeline::calibrate {

struct CalibrateGroundOptions {
  std::optional<marey::calibrate::board::Board> board;  ///< that lies on the floor, in the place of an L-frame of markers
  std::vector<Vector<3>> frame;                         ///< the L-frame's markers, m, on the ground
  std::string observations;  ///< what another program saw of them; empty: they are searched for in the sources
  detect::markers::MarkerOptions markers;
  bool scale = false;  ///< the L-frame's size sets the rig's
};

struct GroundCalibration {
  Rig rig;  ///< moved, so that the ground is z = 0
  marey::calibrate::GroundFound found;
  std::vector<std::string> warnings;  ///< of the cameras' sources, one sentence each
};

/// Origin and axes of a calibrated rig. By a board: its first corner is the origin, x runs along its rows, z up from it; each
/// camera's first image that shows it counts, several cameras are averaged. Throws Error if a source cannot be read, none sees
/// the board, the cameras disagree, or as calibrate::find_ground does; Stopped.
GroundCalibration calibrate_ground(const Rig& rig, const CalibrateGroundOptions& options, const Hooks& hooks = {});

}  // namespace marey::pipeline::calibrate
