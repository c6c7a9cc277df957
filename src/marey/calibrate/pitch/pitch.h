#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/calibrate/pitch/pitch_camera.h"
#include "marey/calibrate/pitch/pitch_fit.h"
#include "marey/core/geometry.h"
#include "marey/geometry/ground_surface.h"
#include "marey/geometry/pitch.h"

namespace marey::calibrate::pitch {

/// What one camera of a pitch is calibrated from.
struct PitchView {
  std::string name;
  cv::Size size;                        ///< px
  std::vector<PitchPoint> points;       ///< in the user's frame, right-handed or not
  std::vector<PitchClickedLine> lines;  ///< the same
  cv::Mat empty_ground;  ///< CV_8UC1 of `size`, people not in it; empty if there are no images: then points alone decide
};

struct PitchCalibrationOptions {
  geometry::PitchSize size;
  GroundKnown known = GroundKnown::nothing;
  geometry::GroundSurface ground = {};  ///< in the world, where it is known wholly
};

/// How one camera came out.
struct PitchViewResult {
  Camera camera;                                      ///< in a right-handed world, m, z up, the pitch's corners on z = 0
  std::vector<char> inlier;                           ///< for each point
  std::vector<double> error_px;                       ///< for each point: from the click to where the camera sees its place
  std::vector<std::optional<double>> error_m;         ///< for each point, on the ground; nothing if the click is in the sky
  std::vector<std::optional<Vector<2>>> better_name;  ///< for each outlier, the place of another clicked name that would fit it
  std::vector<LineSighting> lines;
  double line_median_px = 0, line_95_px = 0;  ///< distances of the paint from the model; 0 where no line was seen
  double line_median_m = 0, line_95_m = 0;
};

struct PitchCalibration {
  Matrix<3> ground_from_world =
      Matrix<3>::Identity();             ///< the users' frame from the world's (x, y, 1): a reflection where theirs is left-handed
  Vector<2> corner = Vector<2>::Zero();  ///< m: where in the users' frame the pitch's corner with the smallest x and y lies
  PitchFit fit;                          ///< of all views: their ground, in the world, and how sure it all is
  std::vector<PitchViewResult> views;
};

/// Lens and pose of every camera over one pitch and the heights of its ground, from points clicked by hand and then from the white
/// lines themselves. Throws Error
/// where a view's points do not decide a camera, or where the views contradict each other: one of them has left and right
/// exchanged.
PitchCalibration calibrate_pitch(const std::vector<PitchView>& views, const PitchCalibrationOptions& options = {});

}  // namespace marey::calibrate::pitch
