#pragma once

#include <span>
#include <vector>

#include "marey/calibrate/board/board_graph.h"
#include "marey/calibrate/board/board_rig.h"

namespace marey::calibrate::board {

struct BoardMotionOptions {
  double knot_s = 0;  ///< time between the path's control poses
  bool refine_lenses = false;
  bool refine_offsets = true;   ///< of all cameras but the first
  bool refine_readout = false;  ///< of all cameras
  double acceleration = 3;      ///< m/s²: what a hand does; holds the path only where nothing is seen
  double ptz = 20;              ///< rad/s²
};

/// The cameras and the board's path, brought to agree. `poses` are the views' own poses, for a start of the path; `start` the
/// cameras'. Corners far off are put out. Deviations are computed where `deviations`.
BoardRig fit_board_motion(const Board& board, std::span<const BoardRigCamera> cameras,
                          const std::vector<std::vector<PosedView>>& poses, const std::vector<BoardRigPose>& start,
                          const BoardMotionOptions& options, bool deviations);

}  // namespace marey::calibrate::board
