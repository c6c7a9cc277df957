#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "marey/geometry/bspline.h"
#include "marey/geometry/vector.h"

namespace marey {

/// How a shape may change from one frame to the next, standard deviations in px.
struct ShapeNoise {
  double bend = 1;       ///< of a control point against the others
  double together = 1;   ///< of a part of the outline some control points wide, as a leg moves
  double shift = 0;      ///< of all alike: how badly the motion is known
  double growth = 0;     ///< relative: of all away from the centre
};

/// The shape filter: the control points of a closed spline, with the covariance of their coordinates x₀ y₀ x₁ y₁ ….
class ShapeFilter {
 public:
  ShapeFilter(ClosedSpline spline, double deviation);

  /// x ← x + shift + growth (x − centre), the paper's prediction; `shift` in px, `growth` relative.
  void predict(const Vector<2>& shift, double growth, const Vector<2>& centre, const ShapeNoise& noise);

  /// Variance, px², of the curve at `place` along `normal`, as it is predicted.
  double variance(const SplineWeights& place, const Vector<2>& normal) const;

  /// The curve at `place` was found `offset` px along `normal` from `foot`, with `noise` px².
  void correct(const SplineWeights& place, const Vector<2>& normal, double innovation, double noise);

  const ClosedSpline& spline() const { return spline_; }
  Vector<2> deviation(int control_point) const;
  Matrix<2> centroid_covariance() const;

 private:
  void project(const SplineWeights& place, const Vector<2>& normal) const;

  ClosedSpline spline_;
  Eigen::MatrixXd P_;
  Eigen::MatrixXd together_;         // correlation of the control points' common motion, by their distance along the curve
  mutable Eigen::VectorXd gain_;     // P h of the line at hand
};

}  // namespace marey
