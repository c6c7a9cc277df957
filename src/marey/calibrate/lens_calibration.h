// A lens from views of a board: Zhang's calibration, ended by bundle adjustment.
//
// The focal length is sought over a grid: for each candidate the board's pose in every view is found from its homography, and the
// candidate that reprojects best is refined, first alone, then with the first coefficient, then with all that is free. No start is
// needed, and likewise serves every lens model. A view that fits far worse than the others (a blurred image, corners
// mistaken) is put out whole, with its reason; then single corners are.
// Reference: Zhang, "A flexible new technique for camera calibration", PAMI 2000.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/calibrate/board/board.h"
#include "marey/calibrate/board/board_detector.h"
#include "marey/calibrate/bundle/bundle.h"

namespace marey::calibrate {

/// A board seen in one image of a lens.
struct LensView {
  std::string name;  ///< what messages call the image
  board::BoardView board;
};

struct LensOptions {
  std::string model = "brown";  ///< brown, fisheye or tsai
  int coefficients = 5;         ///< brown: how many of k1 k2 p1 p2 k3 k4 k5 k6 are free: 0, 1, 2, 4, 5 or 8; fisheye: 1 to 4
  bool square_pixels = false;   ///< one focal length for both axes
};

struct LensCalibration {
  geometry::Lens lens;
  cv::Size size;                      ///< px
  bundle::CameraDeviation deviation;  ///< by the noise seen
  double rms_px = 0, mean_px = 0;
  double noise_px = 0;  ///< each axis
  int inliers = 0, observations = 0;

  struct View {
    std::string name;
    std::optional<Rigid3> camera_from_board;
    double rms_px = 0;
    std::string refused;            ///< why it is not used; empty if it is
    std::vector<Vector<2>> pixels;  ///< of the corners
    std::vector<Vector<2>> errors;  ///< seen minus predicted, px, one for each of `pixels`; empty if there is no pose
  };
  std::vector<View> views;
  double covered = 0;                 ///< share of the image where corners were, 0 to 1, in 10 × 8 fields
  std::vector<std::string> warnings;  ///< what is worth knowing before it is used, one sentence each
};

/// `views` of one board in images of `size` px. Throws Error, with cause and remedy, if they do not determine the lens: fewer than
/// three usable views, or the board at one angle in all.
LensCalibration calibrate_lens(const board::Board& board, cv::Size size, std::span<const LensView> views,
                               const LensOptions& options = {});

/// The lens models' names.
std::vector<std::string> lens_models();

}  // namespace marey::calibrate
