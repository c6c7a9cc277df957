#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/calibrate/board/board_detector.h"
#include "marey/calibrate/lens_calibration.h"
#include "marey/core/hooks.h"
#include "marey/pipeline/corridor/feed.h"

namespace marey::pipeline::calibrate {

/// Images that a lens rests on, if their number is not given.
constexpr std::size_t kViewsOfLens = 60;

/// A board in one frame of a camera.
struct BoardSighting {
  std::int64_t frame = 0;
  Timestamp time{};  ///< by the camera's own clock
  double sharpness = 0;
  marey::calibrate::board::BoardView view;
};

/// All that one camera saw of a board.
struct BoardSightings {
  cv::Size size;                         ///< px
  std::int64_t frames = 0;               ///< searched for the board
  std::vector<BoardSighting> sightings;  ///< in the order of time
  std::vector<std::string> warnings;     ///< the feed's
  std::string why_missing;               ///< in no frame: what the images show in its place (calibrate/board/missing_board.h)
};

struct FindBoardsOptions {
  std::int64_t every = 1;                        ///< only every n-th frame is searched
  std::string step = "searching for the board";  ///< what its progress is called
};

/// Searches for the board in the camera's frames, several at once. Throws Stopped.
BoardSightings find_boards(corridor::Feed& feed, const marey::calibrate::board::BoardDetector& detector,
                           const FindBoardsOptions& options = {}, const Hooks& hooks = {});

/// The lens by the best `max_views` of them. Throws as calibrate::calibrate_lens does.
marey::calibrate::LensCalibration lens_by_sightings(const marey::calibrate::board::Board& board, const BoardSightings& detected,
                                                    std::size_t max_views = kViewsOfLens,
                                                    const marey::calibrate::LensOptions& how = {});

}  // namespace marey::pipeline::calibrate
