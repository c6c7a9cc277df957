#pragma once

#include <optional>
#include <span>

#include <opencv2/core.hpp>

#include "marey/core/detection.h"
#include "marey/geometry/bspline.h"
#include "marey/track/contour/contour_tracker.h"

namespace marey::track::contour {

/// Throws Error if an option is out of its domain.
void check(const OutlineOptions& options);

/// How the options want a target's first silhouette fitted.
geometry::SplineFitOptions fit_options(const OutlineOptions& options);

/// Whether the curve has a loop: then it turns by more, or less, than once in one circuit.
bool is_knotted(const geometry::ClosedSpline& spline);

/// The outline of a silhouette, its edge made exact by `luma` (light_edge.h; may be empty); nothing if it is not a simple curve, or
/// not about as large as the detection.
std::optional<geometry::ClosedSpline> fit_silhouette(const Detection& detected, const cv::Mat& luma,
                                                     geometry::SplineFitOptions options);

/// The spline of a closed curve (px, clockwise), where it is a simple curve and has an area.
std::optional<geometry::ClosedSpline> fit_curve(std::span<const Vector<2>> edge, geometry::SplineFitOptions options);

/// A person who stands in a box, px: what is taken of one who was never seen alone.
std::optional<geometry::ClosedSpline> standing_body(const Box& box, const geometry::SplineFitOptions& options);

/// Whether the curve does not cross itself.
bool is_simple(const geometry::ClosedSpline& spline);

/// Whether the outline of a target in `box` (px) may be this curve: simple, and at most twice as wide as the box or a
/// stride, and 1.6 times as high.
/// With `picture`, what lies outside an image of that size does not count.
bool is_outline_of(const geometry::ClosedSpline& spline, Box box, const cv::Size* image = nullptr);

}  // namespace marey::track::contour
