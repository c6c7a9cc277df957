// All cameras of a pitch and the height of its ground together, from clicks and paint, with as many terms as these pay for.
//
// A crown of a decimetre bends the lines of a pitch much as a lens does. Held level, the ground leaves its crown to the lens, whose
// eight coefficients take it and put places wrong elsewhere; so lens and ground are chosen together: every pair of a row of lenses
// (one radial term … all eight) and a row of grounds (level … all four terms) is fitted, and the one with the least Bayesian
// information criterion is kept. All cameras see one ground, which distinguishes it from a lens.
//
// Errors are weighted as Student's t would (few degrees of freedom: some clicks are gross, some names wrong). Clicks err in pixels
// and, since paint is wide and people do not all mean the same edge, in metres. Paint is averaged over pieces of two metres; pieces
// that follow one another err alike, and count the less for it. How large both errors are is learned from what the richest model
// leaves. Assumes square pixels. Cost: some fifty solutions of a few hundred residuals, a second or two. References: Schwarz,
// "Estimating the dimension of a model", Ann. Stat. 1978; Lange, Little & Taylor, "Robust statistical modeling using the t
// distribution", JASA 1989.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "marey/calibrate/pitch/pitch_camera.h"
#include "marey/calibrate/pitch/pitch_residual.h"
#include "marey/geometry/ground_surface.h"

namespace marey::calibrate::pitch {

/// What decides one camera.
struct PitchEvidence {
  Camera initial;                     ///< lens brown
  std::vector<PitchPoint> points;     ///< in the world
  std::vector<LineSighting> painted;  ///< in order along each line
  std::vector<LineSighting> clicked;
};

/// Prior knowledge of the ground.
enum class GroundKnown {
  nothing,  ///< its terms are chosen
  level,
  wholly,  ///< its terms are held
};

struct PitchFit {
  std::vector<Camera> cameras;
  geometry::GroundSurface ground;
  int lens_terms = 0;
  double click_scale = 1;      ///< what clicks err by, in what is typical
  Eigen::MatrixXd covariance;  ///< of each camera's CameraNumbers in their order, then of the ground's terms; 0 for what is held
};

/// `ground`: where the pitch lies, and its heights where they are known.
PitchFit fit_pitch(const std::vector<PitchEvidence>& evidence, const geometry::GroundSurface& ground, GroundKnown known);

/// What a click's error is worth: the square root of χ² with what clicks usually err by, `pixel` against `seen` of a place.
double click_error(const GroundView& view, const PitchPoint& point);

}  // namespace marey::calibrate::pitch
