// Where several cameras stand, from a board carried before them.
//
// Each camera gives the board's pose in its own frame, so any two that see the board at one time give how they stand to each other.
// These pairs are a graph; its tree of the strongest edges places every camera (board_graph). Then all is refined together:
// cameras, and the board's pose at each instant (stills), or, where the board moves and the cameras are unsynchronised, the board's
// path as a smooth curve that each camera samples at its own times (board_motion). So the offset between cameras that were not
// started together comes out to a fraction of a frame, and so does the time that a rolling shutter takes from the top of the
// image to its bottom. Reference: Furgale, Rehder & Siegwart, "Unified temporal and spatial calibration for multi-sensor
// systems", IROS 2013.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/calibrate/board/board.h"
#include "marey/calibrate/board/board_detector.h"
#include "marey/core/geometry.h"
#include "marey/geometry/lens.h"
#include "marey/geometry/rigid.h"

namespace marey::calibrate::board {

/// The board in one image of a camera.
struct TimedView {
  std::int64_t instant = 0;  ///< stills: images with the same number show the board in the same place
  double time_s = 0;         ///< videos: by the camera's clock
  BoardView view;
};

struct BoardRigCamera {
  std::string name;  ///< what messages call it
  cv::Size size;     ///< px
  geometry::Lens lens;
  double offset_s = 0;  ///< videos: prior value of its offset; where the search begins, and what stays where offsets are held
  std::vector<TimedView> views;  ///< in the order of time
};

struct BoardRigOptions {
  enum class Timing {
    stills,  ///< images of one instant belong together
    videos,  ///< the board moves; offsets and shutters are sought
    synced,  ///< the board moves; offsets are held
  };
  Timing timing = Timing::videos;
  double max_offset_s = 30;      ///< how far the search goes to both sides
  bool refine_lenses = false;    ///< together with the poses
  bool rolling_shutter = false;  ///< videos: the shutters' readout is sought too
};

/// The result for one camera.
struct BoardRigPose {
  geometry::Lens lens;
  Rigid3 camera_from_world;  ///< m; the world is the first camera's frame
  double offset_s = 0;       ///< added to its times gives the first camera's
  double readout_s = 0;      ///< from the exposure of the top row to that of the bottom row; 0 where it was not sought

  double offset_deviation_s = 0;                   ///< standard deviation, by the noise seen; 0 where the offset was not sought
  Vector<3> centre_deviation = Vector<3>::Zero();  ///< m
  double rms_px = 0, mean_px = 0;
  int inliers = 0, observations = 0;
};

struct BoardRig {
  std::vector<BoardRigPose> cameras;
  double rms_px = 0, mean_px = 0, noise_px = 0;  ///< over all; noise: each axis, degrees of freedom taken off
  int inliers = 0, observations = 0;
  double jitter_s = 0;  ///< videos: how unevenly images were taken, standard deviation; 0 where it does not show
  std::vector<std::string> warnings;
};

/// Throws Error, with cause and remedy, where a camera never sees the board at the same time as another one, directly or by way of
/// others, or where the board is not seen often enough.
BoardRig calibrate_board_rig(const Board& board, std::span<const BoardRigCamera> cameras, const BoardRigOptions& options = {});

}  // namespace marey::calibrate::board
