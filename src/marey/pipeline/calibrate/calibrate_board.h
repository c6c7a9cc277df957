#pragma once

#include "marey/calibrate/board/board_rig.h"
#include "marey/core/hooks.h"
#include "marey/core/rig.h"

namespace marey::pipeline::calibrate {

struct BoardRunOptions {
  bool synced = false;           ///< videos of cameras synchronised: their offsets are held as the rig has them
  bool refine = false;           ///< the lenses too
  bool rolling_shutter = false;  ///< videos: the shutters' readout is sought too
  double max_offset_s = 30;      ///< how far cameras are unsynchronised at most
};

struct BoardRun {
  Rig rig;                                  ///< as given, with sizes, lenses, poses and offsets as found
  marey::calibrate::board::BoardRig found;  ///< for the rig's cameras, in their order
};

/// Places the rig's cameras by a board that all their sources show: videos, or images whose n-th belong together. A camera without
/// a lens gets one from the same images first. The world is the one in which the first camera has its pose in the rig; where it
/// has none, the first camera stands at the origin and faces along y, z up. Throws Error if a source cannot be read or
/// calibrate_board_rig refuses; Stopped.
BoardRun calibrate_board(const Rig& rig, const marey::calibrate::board::Board& board, const BoardRunOptions& options,
                         const Hooks& hooks = {});

}  // namespace marey::pipeline::calibrate
