#pragma once

#include "marey/calibrate/board/board.h"
#include "marey/calibrate/ground.h"
#include "marey/core/rig.h"

namespace marey::pipeline {

/// The floor by a board that lies on it, seen in the cameras' sources: its first corner is the origin, x runs along its rows, z up
/// from it. Each camera's first picture that shows it counts; several cameras are averaged. Throws Error where none sees it, or
/// they disagree.
calibrate::GroundFound board_on_ground(const Rig& rig, const calibrate::board::Board& board);

}  // namespace marey::pipeline
