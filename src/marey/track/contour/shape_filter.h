#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "marey/core/geometry.h"
#include "marey/geometry/bspline.h"

namespace marey::track::contour {

/// How an outline may stray from its prediction within one step, standard deviations.
struct ShapeNoise {
  double bend = 0;      ///< px, of a control point against all others
  double together = 0;  ///< px, of neighbouring control points alike, as a leg moves
  double shift = 0;     ///< px, of all alike: how badly the motion is known
  double growth = 0;    ///< relative, of all away from the centre
};

/// The shape filter: the control points of a closed spline, and the covariance of their coordinates.
class ShapeFilter {
 public:
  /// Begins at `spline`, each coordinate known to `deviation` px.
  ShapeFilter(const geometry::ClosedSpline& spline, double deviation);
  /// The same with a deviation for each control point.
  ShapeFilter(geometry::ClosedSpline spline, std::span<const double> deviations);

  /// x ← x + shift + growth (x − centre), the paper's prediction; `shift` in px, `growth` relative.
  void predict(const Vector<2>& shift, double growth, const Vector<2>& centre, const ShapeNoise& noise);

  /// Variance of the curve's position at `place` along the unit vector `normal`, px².
  double variance(const geometry::SplineWeights& location, const Vector<2>& normal) const;

  /// The curve was found at `position` (px along `normal`: a point's dot product with it), with variance `noise` px² > 0.
  /// Nothing is done where the innovation lies beyond `gate` standard deviations; returns whether it was trusted.
  bool correct(const geometry::SplineWeights& location, const Vector<2>& normal, double position, double noise, double gate);

  const geometry::ClosedSpline& spline() const { return spline_; }
  Vector<2> deviation(int control_point) const;  ///< px
  Matrix<2> centroid_covariance() const;         ///< px²

 private:
  /// Fills `gain_` with P h of the line; returns hᵀ P h.
  double project(const geometry::SplineWeights& location, const Vector<2>& normal) const;

  geometry::ClosedSpline spline_;
  Eigen::MatrixXd P_;                   // of x₀ x₁ … y₀ y₁ …, px²
  Eigen::VectorXd alike_;               // correlation of the noise of two control points by how far apart they are
  mutable Eigen::VectorXd gain_, out_;  // what a step needs, kept so that it is allocated once
};

}  // namespace marey::track::contour
