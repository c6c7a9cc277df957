#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "marey/calibrate/board/board_detector.h"
#include "marey/pipeline/feed.h"

namespace marey::pipeline {

/// A board in one frame of a camera.
struct BoardSighting {
  std::int64_t frame = 0;
  Timestamp time{};  ///< by the camera's own clock
  double sharpness = 0;
  calibrate::board::BoardView view;
};

/// All that one camera saw of a board.
struct BoardSightings {
  cv::Size size;                         ///< px
  std::int64_t frames = 0;               ///< looked at
  std::vector<BoardSighting> sightings;  ///< in the order of time
  std::vector<std::string> warnings;     ///< the feed's
};

struct FindBoardsOptions {
  std::int64_t every = 1;                                                   ///< look at every so many-th frame only
  std::function<void(std::int64_t, std::optional<std::int64_t>)> progress;  ///< frames done and in all; may be empty
};

/// Looks for the board in the camera's frames, several at once.
BoardSightings find_boards(Feed& feed, const calibrate::board::BoardDetector& detector, const FindBoardsOptions& options = {});

}  // namespace marey::pipeline
