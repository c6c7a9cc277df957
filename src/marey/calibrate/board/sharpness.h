#pragma once

#include "marey/calibrate/board/board.h"
#include "marey/calibrate/board/board_detector.h"
#include "marey/core/image.h"

namespace marey::calibrate::board {

/// How sharp the edges between a board's squares are in this image: the steepest change of brightness between two pixels, as a
/// share of the step from black to white, median over the corners seen. 1 is as sharp as pixels can be, 0.1 an edge smeared over
/// ten.
double sharpness_of(const Image& image, const BoardView& view);

}  // namespace marey::calibrate::board
