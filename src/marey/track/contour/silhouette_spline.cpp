// How a silhouette becomes an outline: its edge is moved to the edge of light beside it, and a spline is fitted, with its parameter
// corrected (geometry/bspline_fit.cpp). That can tie a loop where the silhouette is thin; then the plain fit by arc length is
// taken, and where that has a loop too, none.
#include "marey/track/contour/silhouette_spline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "marey/core/error.h"
#include "marey/track/contour/intensity_edge.h"

namespace marey::track::contour {
namespace {

constexpr int kMostControlPoints = 64, kMostLines = 512;
constexpr int kFewestControlPoints = 8, kChosenAtMost = 24;  // where the tolerance chooses
constexpr double kLeastArea = 0.5;                           // px²
constexpr double kSameBox = 0.5;  // IoU of an outline's box and the detection's from which on they are the same thing

}  // namespace

void check(const OutlineOptions& options) {
  if (options.order < 2 || options.order > geometry::SplineWeights::max_order) {
    throw Error("an outline of order {} cannot be; give one from 2 to {} (4 is cubic)", options.order,
                +geometry::SplineWeights::max_order);
  }
  const int needed = std::max(options.order, 3);
  if (options.control_points && (*options.control_points < needed || *options.control_points > kMostControlPoints)) {
    throw Error("{} control points for an outline of order {}; give from {} to {}", *options.control_points, options.order, needed,
                kMostControlPoints);
  }
  if (options.lines < 1 || options.lines > kMostLines) {
    throw Error("{} measurement lines an outline; give from 1 to {}", options.lines, kMostLines);
  }
  if (!(options.tolerance > 0)) throw Error("the tolerance of an outline is {} px; it must be positive", options.tolerance);
  if (!(options.least_height >= 1))
    throw Error("the least height of an outline is {} px; it must be 1 or more", options.least_height);
}

geometry::SplineFitOptions fit_options(const OutlineOptions& options) {
  const int needed = std::max(options.order, 3);
  if (options.control_points) return {options.order, *options.control_points, *options.control_points, options.tolerance};
  return {options.order, std::max(needed, kFewestControlPoints), std::max(needed, kChosenAtMost), options.tolerance};
}

bool is_knotted(const geometry::ClosedSpline& spline) {
  constexpr int kPlaces = 4;  // a span
  const int count = kPlaces * spline.count();
  double turned = 0;
  Vector<2> before = spline.derivative(-1.0 / kPlaces);
  for (int i = 0; i < count; ++i) {
    const Vector<2> now = spline.derivative(static_cast<double>(i) / kPlaces);
    turned += std::atan2(before.x() * now.y() - before.y() * now.x(), before.dot(now));
    before = now;
  }
  return std::abs(turned - 2 * std::numbers::pi) > 1;
}

std::optional<geometry::ClosedSpline> fit_silhouette(const Detection& seen, const cv::Mat& luma,
                                                     geometry::SplineFitOptions options) {
  const std::vector<Vector<2>> edge = moved_to_intensity_edges(seen.outline, luma);
  for (const int rounds : {options.rounds, 0}) {
    options.rounds = rounds;
    auto spline = geometry::fit_spline(edge, options);
    if (!spline || !(spline->area() > kLeastArea) || geometry::iou(spline->box(), seen.box) < kSameBox) return std::nullopt;
    if (!is_knotted(*spline)) return spline;
  }
  return std::nullopt;
}

}  // namespace marey::track::contour
