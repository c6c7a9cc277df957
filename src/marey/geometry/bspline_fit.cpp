// A closed spline through a polygon, by least squares. The polygon is sampled evenly along its length, a whole number of samples
// a span, so that the normal matrix is circulant: the same few weights shifted from row to row, positive definite, and small.
// Control points are added until the curve is near enough. Cost: M³ / 3 + a few products a sample for each number M tried.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include <Eigen/Cholesky>

#include "marey/geometry/bspline.h"

namespace marey {
namespace {

constexpr int kPerSpan = 8;  // samples of the polygon

/// The polygon from its topmost, then leftmost corner, clockwise on the screen.
std::vector<Vector<2>> in_order(std::span<const Vector<2>> polygon, bool clockwise) {
  std::vector<Vector<2>> corners(polygon.begin(), polygon.end());
  if (!clockwise) std::reverse(corners.begin(), corners.end());
  const auto top = std::min_element(corners.begin(), corners.end(), [](const Vector<2>& a, const Vector<2>& b) {
    return a.y() != b.y() ? a.y() < b.y() : a.x() < b.x();
  });
  std::rotate(corners.begin(), top, corners.end());
  return corners;
}

double perimeter(std::span<const Vector<2>> corners) {
  double sum = (corners.front() - corners.back()).norm();
  for (std::size_t i = 1; i < corners.size(); ++i) sum += (corners[i] - corners[i - 1]).norm();
  return sum;
}

/// `count` places evenly along the closed polygon, from its first corner: 2 columns.
Eigen::MatrixX2d sampled(std::span<const Vector<2>> corners, double length, int count) {
  Eigen::MatrixX2d samples(count, 2);
  std::size_t edge = 0;
  double walked = 0;
  for (int i = 0; i < count; ++i) {
    const double goal = length * i / count;
    while (true) {
      const Vector<2>& from = corners[edge];
      const Vector<2>& to = corners[edge + 1 < corners.size() ? edge + 1 : 0];
      const double step = (to - from).norm();
      if (goal <= walked + step || edge + 1 == corners.size()) {
        samples.row(i) = (from + (step > 0 ? std::min(1.0, (goal - walked) / step) : 0.0) * (to - from)).transpose();
        break;
      }
      walked += step;
      ++edge;
    }
  }
  return samples;
}

struct Fit {
  Eigen::MatrixX2d points;
  double rms = 0;  // px
};

Fit fit(std::span<const Vector<2>> corners, double length, int order, int count) {
  const Eigen::MatrixX2d samples = sampled(corners, length, count * kPerSpan);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
  Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(count, 2);
  std::array<SplineWeights, kPerSpan> weights;
  for (int i = 0; i < kPerSpan; ++i) weights[i] = spline_weights(order, count, static_cast<double>(i) / kPerSpan);
  for (int s = 0; s < count * kPerSpan; ++s) {
    const SplineWeights& w = weights[s % kPerSpan];
    for (int a = 0; a < order; ++a) {
      const int i = (w.first + s / kPerSpan + a) % count;
      right.row(i) += w.value[a] * samples.row(s);
      for (int b = 0; b < order; ++b) normal(i, (w.first + s / kPerSpan + b) % count) += w.value[a] * w.value[b];
    }
  }
  Fit result;
  result.points = normal.ldlt().solve(right);
  double sum = 0;
  for (int s = 0; s < count * kPerSpan; ++s) {
    const SplineWeights& w = weights[s % kPerSpan];
    Eigen::RowVector2d at = Eigen::RowVector2d::Zero();
    for (int a = 0; a < order; ++a) at += w.value[a] * result.points.row((w.first + s / kPerSpan + a) % count);
    sum += (at - samples.row(s)).squaredNorm();
  }
  result.rms = std::sqrt(sum / (count * kPerSpan));
  return result;
}

}  // namespace

std::optional<ClosedSpline> fit_spline(std::span<const Vector<2>> polygon, const SplineFitOptions& options) {
  assert(options.order >= 2 && options.order <= SplineWeights::max_order && "an order that splines have");
  if (!std::all_of(polygon.begin(), polygon.end(), [](const Vector<2>& p) { return p.allFinite(); })) return std::nullopt;
  if (!polygon_centroid(polygon)) return std::nullopt;
  const std::vector<Vector<2>> corners = in_order(polygon, polygon_area(polygon) > 0);
  const double length = perimeter(corners);
  const int needed = std::max(options.order, 3);
  if (!(length >= needed)) return std::nullopt;
  const int most = std::min(std::max(options.most, needed), static_cast<int>(std::min(length, 1e6)));
  int count = std::clamp(options.least, needed, most);
  Fit best = fit(corners, length, options.order, count);
  while (best.rms > options.tolerance && count < most) best = fit(corners, length, options.order, ++count);
  std::vector<Vector<2>> points;
  points.reserve(count);
  for (int i = 0; i < count; ++i) points.emplace_back(best.points.row(i).transpose());
  return ClosedSpline(options.order, std::move(points));
}

}  // namespace marey
