// Where the search for a camera over a pitch begins: the points are straightened by each of a row of one-parameter distortions
// (Fitzgibbon's division model), and a homography is sought by consensus of four, then by all points within its reach. For either
// hand of the points' frame: clicks nearly on one line determine it only together with a camera.
// Cost: some thousand homographies of a few dozen points. Reference: Fitzgibbon, "Simultaneous linear estimation of multiple view
// geometry and lens distortion", CVPR 2001; Hartley, "In defense of the eight-point algorithm", PAMI 1997 (scaling).
#pragma once

#include <limits>
#include <vector>

#include "marey/calibrate/pitch/pitch_camera.h"
#include "marey/core/geometry.h"

namespace marey::calibrate::pitch {

struct PitchStart {
  Matrix<3> image_from_ground = Matrix<3>::Identity();  ///< image: straightened, in half image widths about the middle
  double strength = 0;                                  ///< of the distortion, per half image width squared
  double cost = std::numeric_limits<double>::infinity();

  /// For each point, whether it is within reach.
  std::vector<char> agreeing(const std::vector<PitchPoint>& points, cv::Size size) const;
};

/// For either hand of the points' frame the best map of each strength, the cheapest first.
struct PitchStarts {
  std::vector<PitchStart> right, left;

  static double cost(const std::vector<PitchStart>& starts) { return starts.empty() ? PitchStart{}.cost : starts.front().cost; }
};

PitchStarts find_pitch_starts(const std::vector<PitchPoint>& points, cv::Size size);

}  // namespace marey::calibrate::pitch
