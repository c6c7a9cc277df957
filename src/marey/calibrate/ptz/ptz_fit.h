// Where a camera on a known tripod is aimed, from paint and from the prediction: three numbers and their covariance.
#pragma once

#include <span>

#include <opencv2/core/types.hpp>

#include "marey/calibrate/ptz/line_markings.h"
#include "marey/core/geometry.h"
#include "marey/geometry/tripod.h"

namespace marey::calibrate::ptz {

/// A heading (pan, tilt, rad; ln of the focal length) and its covariance.
struct Aim {
  geometry::Heading heading;
  Matrix<3> covariance = Matrix<3>::Identity();
};

struct AimOptions {
  double per_line = 8;   ///< samples of one line err together: a line weighs at most as much as this many
  double cut_off = 2.5;  ///< standard deviations: a sample that lies farther off counts little
  int iterations = 8;
  double enough = 0.6;                         ///< fraction of the samples in view: with less, the expectation is tried looser
  double loose_px = 8, loose_reach = 20;       ///< px at 1280: by this deviation, with paint from this far about
  double better = 1.15;                        ///< ratio of merits from which the looser fit is taken
  double click_angle = 0.1, click_zoom = 0.3;  ///< rad, ln f: deviation of a heading that clicks correct
};

/// How well paint fits an aim.
struct AimFit {
  Aim aim;
  int agreeing = 0;      ///< pieces of paint within the cut-off
  int lines = 0;         ///< with three of them or more
  double median_px = 0;  ///< distance of the agreeing ones
};

/// Gauss-Newton on robust residuals with `expected` as prior.
AimFit solve_aim(const geometry::Tripod& tripod, cv::Size size, std::span<const PaintSighting> paint, const Aim& expected,
                 const AimOptions& options = {});

/// ∂pixel/∂(pan, tilt, ln f), px, of a place in the world.
Eigen::Matrix<double, 2, 3> pixel_by_heading(const geometry::Tripod& tripod, const geometry::Heading& heading, cv::Size size,
                                             const Vector<3>& location);

}  // namespace marey::calibrate::ptz
