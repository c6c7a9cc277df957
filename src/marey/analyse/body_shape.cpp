// All figures are functions of the control points, whose coordinates are independent with the deviations that the contour reports:
// their derivatives are differences over a hundredth of a pixel. Cost: four polygons a control point.
#include "marey/analyse/body_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "marey/geometry/bspline.h"
#include "marey/geometry/ground_view.h"

namespace marey::analyse {
namespace {

constexpr double kStep = 0.01;       // px: numerical
constexpr double kFeet = 1.0 / 7;    // of the height: by definition of the leg opening
constexpr double kMaxHidden = 0.25;  // of the control points; unswept
constexpr double kMaxElevation = 4;  // m: physical, no person is higher
constexpr int kHalvings = 40;        // numerical

enum Measure { kArea, kWidth, kHeight, kLean, kLegOpening, kCount };
using Measures = std::array<double, kCount>;

struct Extent {
  Vector<2> low, high;
};

Extent extent_of(const std::vector<Vector<2>>& polygon) {
  Extent extent{polygon[0], polygon[0]};
  for (const Vector<2>& corner : polygon) {
    extent.low = extent.low.cwiseMin(corner);
    extent.high = extent.high.cwiseMax(corner);
  }
  return extent;
}

/// Degrees of the longest axis of a polygon's area from upright.
double lean_of(const std::vector<Vector<2>>& polygon, const Vector<2>& centre) {
  double xx = 0, xy = 0, yy = 0;  // second moments, from triangles about the centre
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector<2> a = polygon[i] - centre, b = polygon[(i + 1) % polygon.size()] - centre;
    const double cross = a.x() * b.y() - b.x() * a.y();
    xx += cross * (a.x() * a.x() + a.x() * b.x() + b.x() * b.x());
    yy += cross * (a.y() * a.y() + a.y() * b.y() + b.y() * b.y());
    xy += cross * (a.x() * a.y() + b.x() * b.y() + (a.x() * b.y() + b.x() * a.y()) / 2);
  }
  const double sign = xx + yy < 0 ? -1 : 1;
  // Upright is −y: an axis that leans to the right has negative xy.
  return std::atan2(-2 * sign * xy, sign * (yy - xx)) / 2 * 180 / std::numbers::pi;
}

double leg_opening_of(const std::vector<Vector<2>>& polygon, const Extent& extent) {
  const double above = extent.high.y() - kFeet * (extent.high.y() - extent.low.y());
  double left = extent.high.x(), right = extent.low.x();
  for (const Vector<2>& corner : polygon) {
    if (corner.y() < above) continue;
    left = std::min(left, corner.x());
    right = std::max(right, corner.x());
  }
  return std::max(0.0, right - left);
}

Measures measures_of(const geometry::ClosedSpline& spline) {
  const std::vector<Vector<2>> polygon = spline.polygon();
  const Extent extent = extent_of(polygon);
  return {std::abs(spline.area()), extent.high.x() - extent.low.x(), extent.high.y() - extent.low.y(),
          lean_of(polygon, spline.centroid()), leg_opening_of(polygon, extent)};
}

/// The highest and the lowest point of a contour.
std::pair<Vector<2>, Vector<2>> head_and_foot(const geometry::ClosedSpline& spline) {
  const std::vector<Vector<2>> polygon = spline.polygon();
  const auto higher = [](const Vector<2>& a, const Vector<2>& b) { return a.y() < b.y(); };
  const auto [head, foot] = std::minmax_element(polygon.begin(), polygon.end(), higher);
  return {*head, *foot};
}

/// m above `foot` of the ground at which a camera sees the row of `head`; nothing if no person is as high.
std::optional<double> height_above(const Camera& camera, const Vector<3>& foot, double head_row) {
  const auto row = [&](double height) -> std::optional<double> {
    const auto pixel = camera.project(foot + Vector<3>(0, 0, height));
    return pixel ? std::optional(pixel->y()) : std::nullopt;
  };
  const auto top = row(kMaxElevation);
  if (!top || *top > head_row) return std::nullopt;
  double low = 0, high = kMaxElevation;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    const auto seen = row(middle);
    if (!seen) return std::nullopt;
    (*seen > head_row ? low : high) = middle;
  }
  return low;
}

std::optional<double> height_of(const GroundView& view, const Vector<2>& head, const Vector<2>& foot) {
  const auto location = view.location(foot);
  if (!location || view.camera() == nullptr) return std::nullopt;
  const Vector<2>& ground = location->ground;
  return height_above(*view.camera(), {ground.x(), ground.y(), view.surface().height(ground)}, head.y());
}

}  // namespace

BodyShape body_shape(const Outline& outline) {
  const geometry::ClosedSpline spline(outline.order, outline.control_points);
  const Measures value = measures_of(spline);
  Measures variance{};
  for (std::size_t i = 0; i < outline.control_points.size() && i < outline.deviations.size(); ++i) {
    for (int axis = 0; axis < 2; ++axis) {
      std::vector<Vector<2>> points = outline.control_points;
      points[i][axis] += kStep;
      const Measures moved = measures_of({outline.order, std::move(points)});
      for (int m = 0; m < kCount; ++m) {
        const auto at = static_cast<std::size_t>(m);
        double change = moved[at] - value[at];
        if (m == kLean && std::abs(change) > 90) change -= std::copysign(180, change);  // an axis has no direction
        variance[at] += std::pow(change / kStep * outline.deviations[i][axis], 2);
      }
    }
  }
  const auto figure = [&](Measure m) { return Figure{value[m], std::sqrt(variance[m])}; };
  return {figure(kArea), figure(kWidth), figure(kHeight), figure(kLean), figure(kLegOpening)};
}

std::optional<BodyOnGround> body_on_ground(const Outline& outline, const GroundView& view) {
  const auto [head, foot] = head_and_foot({outline.order, outline.control_points});
  const auto height = height_of(view, head, foot);
  const double pixels = foot.y() - head.y();
  if (!height || !(pixels > 0) || !(*height > 0)) return std::nullopt;
  double deviation = 0;  // of head and foot alike: the mean of all control points'
  for (const Vector<2>& one : outline.deviations) deviation += one.y() / static_cast<double>(outline.deviations.size());
  const auto higher_head = height_of(view, head - Vector<2>(0, kStep), foot),
             lower_foot = height_of(view, head, foot + Vector<2>(0, kStep));
  if (!higher_head || !lower_foot) return std::nullopt;
  const double by_head = (*higher_head - *height) / kStep, by_foot = (*lower_foot - *height) / kStep;
  const double height_deviation = deviation * std::hypot(by_head, by_foot);
  const double scale = *height / pixels;
  // The scale changes with the place of the foot alone: the head moves height and pixels alike.
  const double scale_deviation = deviation * std::abs(by_foot * pixels - *height) / (pixels * pixels);
  return BodyOnGround{{*height, height_deviation}, {scale, scale_deviation}};
}

bool is_measurable(const Outline& outline) {
  return outline.state != Outline::State::held &&
         static_cast<double>(outline.hidden.size()) <= kMaxHidden * static_cast<double>(outline.control_points.size());
}

}  // namespace marey::analyse
