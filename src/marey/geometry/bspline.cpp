// Closed uniform B-splines. All bases are shifts of one another, so the weights at a place depend only on how far it is into its
// span: the tables of weights that integrals and arc length need are computed once for each order.
//
// The curve is a polynomial of degree k − 1 on each span, so area (Green: ∮ x dy) and first moments (∮ ½x² dy, −∮ ½y² dx) are
// integrals of polynomials of degree at most 3k − 4: Gauss-Legendre quadrature with ⌈(3k − 3) / 2⌉ nodes a span has them exactly.
// Cost: k products for a point of the curve; M times that and a constant for an integral.
// References: Bartels, Beatty & Barsky, "An Introduction to Splines for Use in Computer Graphics and Geometric Modeling", 1987;
// Blake & Isard, "Active Contours", 1998, ch. 3 (integrals over closed splines).
#include "marey/geometry/bspline.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace marey::geometry {
namespace {

constexpr int kMaxOrder = SplineWeights::max_order;

/// The weights `t` in [0, 1] into a span, oldest control point first (Cox & de Boor's recursion for uniform knots).
void span_weights(int order, double t, double* value, double* derivative) {
  value[0] = 1;
  for (int degree = 1; degree < order; ++degree) {
    if (degree == order - 1) {
      for (int j = 0; j <= degree; ++j) derivative[j] = (j > 0 ? value[j - 1] : 0) - (j < degree ? value[j] : 0);
    }
    const double fraction = 1.0 / degree;
    value[degree] = fraction * t * value[degree - 1];
    for (int j = degree - 1; j > 0; --j) value[j] = fraction * ((t + degree - j) * value[j - 1] + (1 - t + j) * value[j]);
    value[0] *= fraction * (1 - t);
  }
}

/// Weights at fixed places within a span, and what each place counts in an integral over the span.
struct SpanTable {
  struct Row {
    double fraction = 0;
    double value[kMaxOrder] = {};
    double derivative[kMaxOrder] = {};
  };
  std::vector<Row> rows;

  void add(int order, double t, double fraction) {
    rows.emplace_back();
    rows.back().fraction = fraction;
    span_weights(order, t, rows.back().value, rows.back().derivative);
  }
};

/// Gauss-Legendre nodes on [0, 1], by Newton's method on the Legendre polynomial.
SpanTable quadrature_table(int order) {
  const int n = (3 * order - 2) / 2;
  SpanTable table;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
    double slope = 1;
    for (int step = 0; step < 50; ++step) {
      double before = 1, p = x;
      for (int k = 2; k <= n; ++k) before = std::exchange(p, ((2 * k - 1) * x * p - (k - 1) * before) / k);
      slope = n * (x * p - before) / (x * x - 1);
      x -= p / slope;
    }
    table.add(order, (1 - x) / 2, 1 / ((1 - x * x) * slope * slope));
  }
  return table;
}

/// Evenly spaced places, the end of the span omitted.
SpanTable even_table(int order, int count) {
  SpanTable table;
  for (int i = 0; i < count; ++i) table.add(order, static_cast<double>(i) / count, 1.0 / count);
  return table;
}

template <typename Make>
std::array<SpanTable, kMaxOrder + 1> tables_by_order(const Make& make) {
  std::array<SpanTable, kMaxOrder + 1> tables;
  for (int order = 2; order <= kMaxOrder; ++order) tables[order] = make(order);
  return tables;
}

const SpanTable& quadrature(int order) {
  static const auto tables = tables_by_order(quadrature_table);
  return tables[order];
}

constexpr int kCoarse = 8, kFine = 32;  // points a span: to place lines; to measure lengths

const SpanTable& coarse(int order) {
  static const auto tables = tables_by_order([](int k) { return even_table(k, kCoarse); });
  return tables[order];
}
const SpanTable& fine(int order) {
  static const auto tables = tables_by_order([](int k) { return even_table(k, kFine); });
  return tables[order];
}

/// Control point `index` may lie one round beyond the last.
const Vector<2>& wrapped(std::span<const Vector<2>> points, std::size_t index) {
  return points[index < points.size() ? index : index - points.size()];
}

Vector<2> weighted(std::span<const Vector<2>> points, int first, int order, const double* weights) {
  Vector<2> sum = Vector<2>::Zero();
  for (int j = 0; j < order; ++j) sum += weights[j] * wrapped(points, first + j);
  return sum;
}

/// Calls `visit` with every place of the table on every span: first control point, row, point and derivative of the curve.
template <typename Visit>
void for_each_position(const ClosedSpline& spline, const SpanTable& table, const Visit& visit) {
  const std::span<const Vector<2>> points = spline.control_points();
  for (int first = 0; first < spline.count(); ++first) {
    for (const SpanTable::Row& row : table.rows) {
      visit(first, row, weighted(points, first, spline.order(), row.value),
            weighted(points, first, spline.order(), row.derivative));
    }
  }
}

/// Area and its first moments round the first control point, where digits are not lost.
struct TimeSteps {
  double area = 0;
  Vector<2> first = Vector<2>::Zero();
};

TimeSteps time_steps(const ClosedSpline& spline, const Vector<2>& origin) {
  TimeSteps sum;
  for_each_position(spline, quadrature(spline.order()),
                    [&](int, const SpanTable::Row& row, const Vector<2>& at, const Vector<2>& slope) {
                      const Vector<2> p = at - origin;
                      sum.area += row.fraction * p.x() * slope.y();
                      sum.first.x() += row.fraction * 0.5 * p.x() * p.x() * slope.y();
                      sum.first.y() -= row.fraction * 0.5 * p.y() * p.y() * slope.x();
                    });
  return sum;
}

bool has_area(double area, double scale) {
  return std::abs(area) > 1e-9 * scale * scale;
}

double spread(std::span<const Vector<2>> points) {
  double maximum = 0;
  for (const Vector<2>& point : points) maximum = std::max(maximum, (point - points.front()).cwiseAbs().maxCoeff());
  return maximum;
}

Vector<2> mean(std::span<const Vector<2>> points) {
  Vector<2> sum = Vector<2>::Zero();
  for (const Vector<2>& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

}  // namespace

SplineWeights spline_weights(int order, int count, double u) {
  assert(order >= 2 && order <= kMaxOrder && count >= order && std::isfinite(u) && "a place on a closed spline");
  const double shifted = u + order / 2.0;
  const double span = std::floor(shifted);
  SplineWeights weights;
  span_weights(order, shifted - span, weights.value, weights.derivative);
  const double first = std::fmod(span - order + 1, count);
  weights.first = static_cast<int>(first < 0 ? first + count : first);
  return weights;
}

ClosedSpline::ClosedSpline(int order, std::vector<Vector<2>> control_points) : order_(order), points_(std::move(control_points)) {
  assert(order >= 2 && order <= kMaxOrder && count() >= std::max(order, 3) && "control points enough for the order");
  assert(std::all_of(points_.begin(), points_.end(), [](const Vector<2>& p) { return p.allFinite(); }) && "finite control points");
}

Vector<2> ClosedSpline::at(double u) const {
  const SplineWeights weights = spline_weights(order_, count(), u);
  return weighted(points_, weights.first, order_, weights.value);
}

Vector<2> ClosedSpline::derivative(double u) const {
  const SplineWeights weights = spline_weights(order_, count(), u);
  return weighted(points_, weights.first, order_, weights.derivative);
}

std::optional<Vector<2>> ClosedSpline::normal(double u) const {
  const Vector<2> tangent = derivative(u);
  const double length = tangent.norm();
  if (!(length > 1e-9 * (1 + spread(points_)))) return std::nullopt;
  return Vector<2>(tangent.y() / length, -tangent.x() / length);
}

double ClosedSpline::area() const {
  return time_steps(*this, points_.front()).area;
}

Vector<2> ClosedSpline::centroid() const {
  const TimeSteps sum = time_steps(*this, points_.front());
  if (!has_area(sum.area, spread(points_))) return mean(points_);
  return points_.front() + sum.first / sum.area;
}

Eigen::Matrix<double, 2, Eigen::Dynamic> ClosedSpline::centroid_gradient() const {
  Eigen::Matrix<double, 2, Eigen::Dynamic> gradient = Eigen::Matrix<double, 2, Eigen::Dynamic>::Zero(2, 2 * count());
  const double area = this->area();
  if (!has_area(area, spread(points_))) {
    for (int i = 0; i < count(); ++i) gradient.middleCols<2>(2 * i) = Matrix<2>::Identity() / count();
    return gradient;
  }
  const Vector<2> centre = centroid();  // the origin: there the first moments vanish, and the area's own gradient with them
  for_each_position(*this, quadrature(order_),
                    [&](int first, const SpanTable::Row& row, const Vector<2>& at, const Vector<2>& slope) {
                      const Vector<2> p = at - centre;
                      const double fraction = row.fraction / area;
                      for (int j = 0; j < order_; ++j) {
                        const int i = first + j < count() ? first + j : first + j - count();
                        const double value = fraction * row.value[j], derivative = fraction * row.derivative[j];
                        gradient(0, 2 * i) += p.x() * value * slope.y();
                        gradient(0, 2 * i + 1) += 0.5 * p.x() * p.x() * derivative;
                        gradient(1, 2 * i) -= 0.5 * p.y() * p.y() * derivative;
                        gradient(1, 2 * i + 1) -= p.y() * value * slope.x();
                      }
                    });
  return gradient;
}

double ClosedSpline::length() const {
  double sum = 0;
  std::optional<Vector<2>> before;
  Vector<2> start = points_.front();
  for_each_position(*this, fine(order_), [&](int first, const SpanTable::Row&, const Vector<2>& at, const Vector<2>&) {
    if (before) {
      sum += (at - *before).norm();
    } else if (first == 0) {
      start = at;
    }
    before = at;
  });
  return sum + (start - *before).norm();
}

void ClosedSpline::evenly_spaced(std::span<double> locations) const {
  const SpanTable& table = coarse(order_);
  const int steps = count() * kCoarse;
  // Table rows begin at control point 0's span, which is u = order / 2 − 1 before wrapping: walk from there, from u = 0 on.
  const double offset = order_ / 2.0 - 1;
  const int begin = static_cast<int>(std::lround((count() - offset) * kCoarse)) % steps;
  const auto point = [&](int step) {
    const int index = (begin + step) % steps;
    return weighted(points_, index / kCoarse, order_, table.rows[index % kCoarse].value);
  };
  double total = 0;
  Vector<2> before = point(0);
  for (int step = 1; step <= steps; ++step) {
    const Vector<2> at = point(step);
    total += (at - before).norm();
    before = at;
  }
  const double spacing = total / static_cast<double>(locations.size());
  double walked = 0;
  std::size_t next = 0;
  before = point(0);
  for (int step = 1; step <= steps && next < locations.size(); ++step) {
    const Vector<2> at = point(step);
    const double chord = (at - before).norm();
    for (; next < locations.size() && spacing * static_cast<double>(next) <= walked + chord; ++next) {
      const double part = chord > 0 ? (spacing * static_cast<double>(next) - walked) / chord : 0;
      locations[next] = (step - 1 + part) / kCoarse;
    }
    walked += chord;
    before = at;
  }
  for (; next < locations.size(); ++next) locations[next] = 0;  // rounding, or a curve that is a point
}

std::vector<Vector<2>> ClosedSpline::polygon(int per_span) const {
  std::vector<Vector<2>> result;
  result.reserve(static_cast<std::size_t>(count()) * per_span);
  for (int i = 0; i < count() * per_span; ++i) result.push_back(at(static_cast<double>(i) / per_span));
  return result;
}

Box ClosedSpline::box() const {
  constexpr double kHuge = std::numeric_limits<double>::infinity();
  Vector<2> minimum(kHuge, kHuge), maximum(-kHuge, -kHuge);
  for_each_position(*this, coarse(order_), [&](int, const SpanTable::Row&, const Vector<2>& at, const Vector<2>&) {
    minimum = minimum.cwiseMin(at);
    maximum = maximum.cwiseMax(at);
  });
  return {minimum.x() + 0.5, minimum.y() + 0.5, maximum.x() - minimum.x(), maximum.y() - minimum.y()};
}

double polygon_area(std::span<const Vector<2>> polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector<2> a = polygon[i] - polygon[0], b = polygon[i + 1 < polygon.size() ? i + 1 : 0] - polygon[0];
    twice += a.x() * b.y() - b.x() * a.y();
  }
  return twice / 2;
}

std::optional<Vector<2>> polygon_centroid(std::span<const Vector<2>> polygon) {
  const double area = polygon_area(polygon);
  if (polygon.size() < 3 || !std::isfinite(area) || !has_area(area, spread(polygon))) return std::nullopt;
  Vector<2> sum = Vector<2>::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector<2> a = polygon[i] - polygon[0], b = polygon[i + 1 < polygon.size() ? i + 1 : 0] - polygon[0];
    sum += (a.x() * b.y() - b.x() * a.y()) * (a + b);
  }
  return polygon[0] + sum / (6 * area);
}

}  // namespace marey::geometry
