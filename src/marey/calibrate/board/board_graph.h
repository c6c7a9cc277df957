#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/calibrate/board/board_rig.h"

namespace marey::calibrate::board {

/// The board in one image, as its camera alone would have it.
struct PosedView {
  double time_s = 0;  ///< videos: by the camera's clock; stills: the instant
  Rigid3 camera_from_board;
};

/// How a second camera stands to a first one.
struct BoardPair {
  Rigid3 second_from_first;
  double offset_s = 0;  ///< the first camera's time minus the second's at one instant
  int common = 0;       ///< views that say so
  double spread = 0;    ///< median disagreement of the single views: rad, and metres a metre of distance
};

/// Compares two cameras' views. Where `max_offset_s` is above 0 every offset up to that is tried, around `offset_s`, in steps of
/// half a frame, and the one at which the views agree best is taken; the board must have moved then. Otherwise `offset_s` holds.
/// Nothing if fewer than three views are common.
std::optional<BoardPair> compare_views(std::span<const PosedView> first, std::span<const PosedView> second, double offset_s,
                                       double max_offset_s);

/// A first guess of every camera: pose in the frame of camera 0, and offset to its clock.
struct BoardPlacement {
  Rigid3 camera_from_world;
  double offset_s = 0;
};

/// Places all cameras by the strongest pairs. Throws Error that names the cameras which share no view with the others.
std::vector<BoardPlacement> position_cameras(const std::vector<std::vector<PosedView>>& views,
                                             std::span<const BoardRigCamera> cameras, const BoardRigOptions& options);

}  // namespace marey::calibrate::board
