#pragma once

#include <span>
#include <string>

#include "marey/calibrate/board/board.h"
#include "marey/core/image.h"

namespace marey::calibrate::board {

/// Why a board is in none of these images, as far as they show it, in words that follow a colon: markers of another dictionary,
/// with the board that fits in place of the one given; more or fewer squares; black and white exchanged; squares that are too
/// small; blur; darkness; else that nothing like it is detected. Cost: up to two seconds for twelve images.
std::string why_missing(const Board& board, std::span<const Image> images);

}  // namespace marey::calibrate::board
