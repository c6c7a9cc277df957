#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "marey/geometry/box.h"
#include "marey/geometry/vector.h"

namespace marey::geometry {

/// The basis functions of the uniform B-spline of one order that are not zero at one place of a closed curve.
struct SplineWeights {
  static constexpr int max_order = 8;

  int first = 0;                      ///< control point of `value[0]`, in [0, M); the next are first + 1, … modulo M
  double value[max_order] = {};       ///< `order` of them, ≥ 0, sum 1
  double derivative[max_order] = {};  ///< by u; sum 0
};

/// The weights at `u` (finite; periodic in [0, count)) for `count` ≥ `order` control points, 2 ≤ `order` ≤ max_order.
SplineWeights spline_weights(int order, int count, double u);

/// A closed uniform B-spline in the plane: x(u) = Σ xᵢ B(u − i), u periodic in [0, M), with B symmetric round 0, so that control
/// point i pulls most at u = i. `order` is degree + 1: 4 for cubic. Orientation is as seen on the screen, y pointing down.
class ClosedSpline {
 public:
  /// 2 ≤ `order` ≤ SplineWeights::max_order; at least `order` control points, and at least 3; all finite.
  ClosedSpline(int order, std::vector<Vector<2>> control_points);

  int order() const { return order_; }
  int count() const { return static_cast<int>(points_.size()); }
  const std::vector<Vector<2>>& control_points() const { return points_; }
  /// To be moved, not to be more or fewer.
  std::span<Vector<2>> control_points() { return points_; }

  Vector<2> at(double u) const;
  Vector<2> derivative(double u) const;
  /// Unit length; out of a curve that runs clockwise. Nothing if the derivative vanishes (a cusp).
  std::optional<Vector<2>> normal(double u) const;

  /// px²; exact. Positive for a curve that runs clockwise on the screen; where it crosses itself, loops count by their sense.
  double area() const;
  /// Centre of the area; the mean of the control points where the area is 0.
  Vector<2> centroid() const;
  /// Derivatives of the centroid's x (row 0) and y (row 1) by x₀ y₀ x₁ y₁ …: 2 × 2M.
  Eigen::Matrix<double, 2, Eigen::Dynamic> centroid_gradient() const;

  /// px; of the polygon of 32 points a span.
  double length() const;
  /// Parameters of `places.size()` places evenly spaced along the curve, the first at u = 0, to a hundredth of a span.
  void evenly_spaced(std::span<double> locations) const;

  /// `per_span` ≥ 1 points for each control point, in the order of u from 0.
  std::vector<Vector<2>> polygon(int per_span = 8) const;
  /// What the polygon spans, in pixels covered (as Box counts them).
  Box box() const;

 private:
  int order_;
  std::vector<Vector<2>> points_;
};

/// How a polygon becomes a spline.
struct SplineFitOptions {
  int order = 4;           ///< 2 … SplineWeights::max_order
  int minimum = 8;         ///< control points to begin with
  int maximum = 24;        ///< and to end with; both are raised to what the order needs
  double tolerance = 0.5;  ///< px, RMS distance between polygon and curve; the fewest control points that reach it are taken
  int rounds = 4;          ///< that the parameter of the samples is corrected; 0 for the plain fit by arc length
};

/// The least-squares spline of a closed polygon (ordered corners, edges counted by their length); its parameter goes with arc
/// length, from the polygon's topmost corner (of several the leftmost) clockwise on the screen. It has no more control points than
/// the polygon has px of length. Nothing if that is fewer than the order needs, or the polygon has fewer than 3 corners, no
/// area, or a corner that is not finite.
std::optional<ClosedSpline> fit_spline(std::span<const Vector<2>> polygon, const SplineFitOptions& options = {});

/// Area by the shoelace formula, px²: positive where the corners run clockwise on the screen.
double polygon_area(std::span<const Vector<2>> polygon);
/// Centre of the area; nothing if it has no area.
std::optional<Vector<2>> polygon_centroid(std::span<const Vector<2>> polygon);

}  // namespace marey::geometry
