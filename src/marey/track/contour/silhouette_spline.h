#pragma once

#include <optional>

#include "marey/core/detection.h"
#include "marey/geometry/bspline.h"
#include "marey/track/contour/outline_follower.h"

namespace marey::track::contour {

/// Throws Error where an option is out of its domain.
void check(const OutlineOptions& options);

/// How the options want a target's first silhouette fitted.
geometry::SplineFitOptions fit_options(const OutlineOptions& options);

/// Whether the curve has a loop: then it turns by more, or less, than once on its way round.
bool is_knotted(const geometry::ClosedSpline& spline);

/// The outline of a silhouette, its edge made exact by `luma` (light_edge.h; may be empty); nothing where it is no simple curve, or
/// not about as large as the detection.
std::optional<geometry::ClosedSpline> fit_silhouette(const Detection& seen, const cv::Mat& luma,
                                                     geometry::SplineFitOptions options);

}  // namespace marey::track::contour
