#pragma once

#include <span>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/calibrate/board/board_detector.h"

namespace marey::calibrate::board {

/// A view of a board that may be taken.
struct ViewCandidate {
  const BoardView* view = nullptr;
  double sharpness = 0;  ///< sharpness_of
};

/// The views, at most `most`, that together show most of a lens, as rising indices. The blurred ones (less than half as sharp as
/// the median) are omitted; then one after the other that is taken which shows corners where there are fewest so far, and the
/// board at a size and slant least like those taken. Cost: most × candidates × corners.
std::vector<std::size_t> choose_views(std::span<const ViewCandidate> candidates, cv::Size size, std::size_t maximum);

}  // namespace marey::calibrate::board
