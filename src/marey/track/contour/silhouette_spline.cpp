// How a silhouette becomes an outline: its edge is moved to the edge of light beside it, and a spline is fitted, with its parameter
// corrected (geometry/bspline_fit.cpp). That can tie a loop where the silhouette is thin; then the plain fit by arc length is
// taken, and where that has a loop too, a curve that begins as the smoothed edge and is drawn towards it while it stays simple.
#include "marey/track/contour/silhouette_spline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "marey/core/error.h"
#include "marey/track/contour/contour_target.h"
#include "marey/track/contour/intensity_edge.h"

namespace marey::track::contour {
namespace {

constexpr int kMaxControlPoints = 64, kMaxLines = 512;
// Where the tolerance chooses. Both arms and both legs of one who runs need more than 32; 48 come no nearer than 40 (bench/outlines
// of 25 to 120 px).
constexpr int kMinControlPoints = 8, kMaxChosen = 40;
constexpr double kMinArea = 0.5;  // px²
constexpr double kSameBox = 0.5;  // IoU of an outline's box and the detection's from which on they are the same thing

/// `count` places at equal distances along a closed polygon.
std::vector<Vector<2>> evenly_along(std::span<const Vector<2>> corners, int count) {
  double length = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) length += (corners[(i + 1) % corners.size()] - corners[i]).norm();
  std::vector<Vector<2>> locations;
  double walked = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector<2> along = corners[(i + 1) % corners.size()] - corners[i];
    const double edge = along.norm();
    while (std::ssize(locations) < count) {
      const double goal = length * static_cast<double>(locations.size()) / count;
      if (goal > walked + edge) break;
      locations.emplace_back(corners[i] + (edge > 0 ? (goal - walked) / edge : 0) * along);
    }
    walked += edge;
  }
  while (std::ssize(locations) < count) locations.push_back(corners.front());
  return locations;
}

}  // namespace

void check(const OutlineOptions& options) {
  if (options.order < 2 || options.order > geometry::SplineWeights::max_order) {
    throw Error("an outline of order {} cannot be; give one from 2 to {} (4 is cubic)", options.order,
                +geometry::SplineWeights::max_order);
  }
  const int needed = std::max(options.order, 3);
  if (options.control_points && (*options.control_points < needed || *options.control_points > kMaxControlPoints)) {
    throw Error("{} control points for an outline of order {}; give from {} to {}", *options.control_points, options.order, needed,
                kMaxControlPoints);
  }
  if (options.lines < 1 || options.lines > kMaxLines) {
    throw Error("{} measurement lines an outline; give from 1 to {}", options.lines, kMaxLines);
  }
  if (!(options.tolerance > 0)) throw Error("the tolerance of an outline is {} px; it must be positive", options.tolerance);
  if (!(options.min_height >= 1)) throw Error("the least height of an outline is {} px; it must be 1 or more", options.min_height);
}

geometry::SplineFitOptions fit_options(const OutlineOptions& options) {
  const int needed = std::max(options.order, 3);
  if (options.control_points) return {options.order, *options.control_points, *options.control_points, options.tolerance};
  return {options.order, std::max(needed, kMinControlPoints), std::max(needed, kMaxChosen), options.tolerance};
}

bool is_knotted(const geometry::ClosedSpline& spline) {
  constexpr int kPositions = 4;  // a span; numerical
  const int count = kPositions * spline.count();
  double rotated = 0;
  Vector<2> before = spline.derivative(-1.0 / kPositions);
  for (int i = 0; i < count; ++i) {
    const Vector<2> now = spline.derivative(static_cast<double>(i) / kPositions);
    rotated += std::atan2(before.x() * now.y() - before.y() * now.x(), before.dot(now));
    before = now;
  }
  return std::abs(rotated - 2 * std::numbers::pi) > 1;
}

bool is_simple(const geometry::ClosedSpline& spline) {
  const std::vector<Vector<2>> points = spline.polygon(8);
  const std::size_t count = points.size();
  struct Segment {
    double left, right, top, bottom;
    std::size_t begin;
  };
  std::vector<Segment> segments(count);
  const auto end_of = [&](std::size_t i) -> const Vector<2>& { return points[i + 1 < count ? i + 1 : 0]; };
  for (std::size_t i = 0; i < count; ++i) {
    const Vector<2>&a = points[i], &b = end_of(i);
    segments[i] = {std::min(a.x(), b.x()), std::max(a.x(), b.x()), std::min(a.y(), b.y()), std::max(a.y(), b.y()), i};
  }
  std::sort(segments.begin(), segments.end(), [](const Segment& a, const Segment& b) { return a.left < b.left; });
  const auto side = [](const Vector<2>& a, const Vector<2>& b, const Vector<2>& p) {
    return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
  };
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count && segments[j].left <= segments[i].right; ++j) {
      if (segments[j].top > segments[i].bottom || segments[j].bottom < segments[i].top) continue;
      const std::size_t one = segments[i].begin, other = segments[j].begin, apart = one > other ? one - other : other - one;
      if (apart <= 1 || apart == count - 1) continue;
      const Vector<2>&a = points[one], &b = end_of(one), &c = points[other], &d = end_of(other);
      if (side(a, b, c) * side(a, b, d) <= 0 && side(c, d, a) * side(c, d, b) <= 0) return false;
    }
  }
  return true;
}

bool is_outline_of(const geometry::ClosedSpline& spline, Box box, const cv::Size* image) {
  constexpr double kMostWide = 2, kMostHigh = 1.6;
  Box own = spline.box();
  if (image != nullptr) {
    const Box detected{0, 0, static_cast<double>(image->width), static_cast<double>(image->height)};
    own = geometry::intersection(own, detected);
  }
  const double width = std::max(box.width, kStrideWidth * box.height);
  return own.width <= kMostWide * width && own.height <= kMostHigh * box.height && is_simple(spline);
}

namespace {

bool is_above(const Vector<2>& a, const Vector<2>& b) {
  return a.y() != b.y() ? a.y() < b.y() : a.x() < b.x();
}

/// The curve whose control points lie evenly along the edge, drawn towards the edge step by step for as long as it stays simple:
/// progressive iterative approximation (Lin, Bao & Wang, "Totally positive bases and progressive iteration approximation", 2005),
/// ended early.
std::optional<geometry::ClosedSpline> drawn_to(std::span<const Vector<2>> edge, int order, int count) {
  constexpr int kDrawingSteps = 12;
  std::vector<Vector<2>> corners(edge.begin(), edge.end());
  if (geometry::polygon_area(corners) < 0) std::reverse(corners.begin(), corners.end());
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end(), is_above), corners.end());
  const std::vector<Vector<2>> goals = evenly_along(corners, count);
  geometry::ClosedSpline spline(order, goals);
  if (is_knotted(spline) || !is_simple(spline) || !(spline.area() > kMinArea)) return std::nullopt;
  for (int step = 0; step < kDrawingSteps; ++step) {
    std::vector<Vector<2>> points = std::as_const(spline).control_points();
    for (int i = 0; i < count; ++i) points[i] += goals[i] - spline.at(i);
    geometry::ClosedSpline nearer(order, std::move(points));
    if (is_knotted(nearer) || !is_simple(nearer)) break;
    spline = std::move(nearer);
  }
  return spline;
}

}  // namespace

std::optional<geometry::ClosedSpline> fit_curve(std::span<const Vector<2>> edge, geometry::SplineFitOptions options) {
  std::optional<geometry::ClosedSpline> spline;
  for (const int rounds : {options.rounds, 0}) {
    options.rounds = rounds;
    spline = geometry::fit_spline(edge, options);
    if (!spline || !(spline->area() > kMinArea)) return std::nullopt;
    if (!is_knotted(*spline) && is_simple(*spline)) return spline;
  }
  return drawn_to(edge, options.order, spline->count());
}

std::optional<geometry::ClosedSpline> standing_body(const Box& box, const geometry::SplineFitOptions& options) {
  // Half of it, in heights from the middle of the top: head, shoulder, hand, hip, foot.
  constexpr std::array<std::array<double, 2>, 9> kHalf{
      {{0.03, 0}, {0.06, 0.05}, {0.05, 0.13}, {0.12, 0.18}, {0.14, 0.42}, {0.1, 0.52}, {0.1, 0.75}, {0.09, 1}, {0.03, 1}}};
  std::vector<Vector<2>> polygon;
  const Vector<2> top(box.left + box.width / 2 - 0.5, box.top - 0.5);
  for (const auto& [x, y] : kHalf) polygon.emplace_back(top + box.height * Vector<2>(x, y));
  for (auto half = kHalf.rbegin(); half != kHalf.rend(); ++half) {
    polygon.emplace_back(top + box.height * Vector<2>(-(*half)[0], (*half)[1]));
  }
  return fit_curve(polygon, options);
}

std::optional<geometry::ClosedSpline> fit_silhouette(const Detection& detected, const cv::Mat& luma,
                                                     geometry::SplineFitOptions options) {
  auto spline = fit_curve(moved_to_intensity_edges(detected.outline, luma), options);
  if (!spline || geometry::iou(spline->box(), detected.box) < kSameBox) return std::nullopt;
  return spline;
}

}  // namespace marey::track::contour
