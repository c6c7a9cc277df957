// A closed spline through a polygon, by least squares. The polygon is sampled evenly along its length, a whole number of samples
// a span, so that the normal matrix is circulant: the same few weights shifted from row to row, positive definite, and small.
// Then the parameter of each sample is corrected to the place on the curve that is nearest to it, and the curve fitted again, so
// that control points gather where the polygon bends. Cost: M³ / 6 + 4 M k² a round; log₂ of the range for the number M. Reference:
// Hoschek, "Intrinsic parametrization for approximation", Computer Aided Geometric Design 5(1), 1988.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include <Eigen/Cholesky>

#include "marey/geometry/bspline.h"

namespace marey::geometry {
namespace {

constexpr int kPerSpan = 4;           // samples of the polygon
constexpr double kEager = 1.5;        // times Newton's step: the steps of neighbours help one another
constexpr double kStationary = 1e-9;  // keeps a control point that no sample is near from running away

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
  Eigen::MatrixXd normal;
  Eigen::LLT<Eigen::MatrixXd> solver;
  double rms = 0;  // px
};

/// The least-squares curve through the samples at parameters `places`. The normal matrix is banded but for its corners, where the
/// curve closes; only its lower half is filled in.
void solve(const Eigen::MatrixX2d& samples, std::span<const double> locations, int order, Fit& fit) {
  const int count = static_cast<int>(fit.points.rows());
  fit.normal.setZero(count, count);
  fit.points.setZero();
  for (int s = 0; s < samples.rows(); ++s) {
    const SplineWeights w = spline_weights(order, count, locations[s]);
    for (int a = 0; a < order; ++a) {
      const int i = w.first + a < count ? w.first + a : w.first + a - count;
      fit.points(i, 0) += w.value[a] * samples(s, 0);
      fit.points(i, 1) += w.value[a] * samples(s, 1);
      for (int b = 0; b <= a; ++b) {
        const int j = w.first + b < count ? w.first + b : w.first + b - count;
        fit.normal(std::max(i, j), std::min(i, j)) += w.value[a] * w.value[b];
      }
    }
  }
  fit.normal.diagonal().array() += kStationary;
  fit.solver.compute(fit.normal);
  fit.solver.solveInPlace(fit.points);
}

/// Moves each sample's parameter to the place on the curve that is nearest to it, by one step of Newton's method, and never past
/// its neighbours. Returns the RMS distance there.
double correct_positions(const Eigen::MatrixX2d& samples, int order, const Eigen::MatrixX2d& points, std::span<double> locations) {
  const int count = static_cast<int>(points.rows());
  const double maximum = 0.5 * count / static_cast<double>(samples.rows());
  double sum = 0;
  for (int s = 0; s < samples.rows(); ++s) {
    const SplineWeights w = spline_weights(order, count, locations[s]);
    Eigen::RowVector2d at = Eigen::RowVector2d::Zero(), slope = Eigen::RowVector2d::Zero();
    for (int a = 0; a < order; ++a) {
      const int i = w.first + a < count ? w.first + a : w.first + a - count;
      at += w.value[a] * points.row(i);
      slope += w.derivative[a] * points.row(i);
    }
    const Eigen::RowVector2d gap = samples.row(s) - at;
    sum += gap.squaredNorm();
    const double speed = slope.squaredNorm();
    if (speed > 0) locations[s] += std::clamp(kEager * gap.dot(slope) / speed, -maximum, maximum);
  }
  return std::sqrt(sum / static_cast<double>(samples.rows()));
}

Fit fit(std::span<const Vector<2>> corners, double length, int order, int count, int rounds) {
  const Eigen::MatrixX2d samples = sampled(corners, length, count * kPerSpan);
  std::vector<double> locations(samples.rows());
  for (std::size_t s = 0; s < locations.size(); ++s) locations[s] = static_cast<double>(s) / kPerSpan;
  Fit result{.points = Eigen::MatrixX2d(count, 2), .normal = {}, .solver = {}};
  for (int round = 0; round <= rounds; ++round) {
    solve(samples, locations, order, result);
    result.rms = correct_positions(samples, order, result.points, locations);
  }
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
  const int maximum = std::min(std::max(options.maximum, needed), static_cast<int>(std::min(length, 1e6)));
  int low = std::clamp(options.minimum, needed, maximum), high = std::max(low, maximum);
  Fit best = fit(corners, length, options.order, high, options.rounds);
  if (low < high && best.rms <= options.tolerance) {
    // The fewest that are enough, by bisection: more control points come nearer, but for a hair.
    while (low < high) {
      const int middle = (low + high) / 2;
      Fit tried = fit(corners, length, options.order, middle, options.rounds);
      if (tried.rms <= options.tolerance) {
        best = std::move(tried);
        high = middle;
      } else {
        low = middle + 1;
      }
    }
  }
  const int count = high;
  std::vector<Vector<2>> points;
  points.reserve(count);
  for (int i = 0; i < count; ++i) points.emplace_back(best.points.row(i).transpose());
  return ClosedSpline(options.order, std::move(points));
}

}  // namespace marey::geometry
