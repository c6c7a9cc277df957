#include "marey/core/skeleton.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/LU>

namespace marey {
namespace {

/// The nearest of all angles that are this one.
double unwound(double angle, double near) {
  return angle + 2 * std::numbers::pi * std::round((near - angle) / (2 * std::numbers::pi));
}

Rigid3 moved_along(const JointAxis& axis, double amount) {
  Rigid3 move;
  if (axis.is_rotation) {
    move.rotation = Eigen::AngleAxisd(amount, axis.axis).toRotationMatrix();
  } else {
    move.translation = amount * axis.axis;
  }
  return move;
}

}  // namespace

CoordinateFunction CoordinateFunction::linear(double slope, double offset) {
  return polynomial({offset, slope});
}

CoordinateFunction CoordinateFunction::polynomial(std::vector<double> coefficients) {
  CoordinateFunction function;
  function.function_ = std::move(coefficients);
  return function;
}

CoordinateFunction CoordinateFunction::spline(std::vector<double> x, std::vector<double> y) {
  const std::size_t n = x.size();
  CoordinateFunction result;
  if (n == 2) return linear((y[1] - y[0]) / (x[1] - x[0]), y[0] - x[0] * (y[1] - y[0]) / (x[1] - x[0]));
  // A tridiagonal system for c: b its diagonal, d beside it, c the right-hand side.
  std::vector<double> b(n), c(n), d(n), slope(n);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    d[i] = x[i + 1] - x[i];
    slope[i] = (y[i + 1] - y[i]) / d[i];
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    b[i] = 2 * (d[i - 1] + d[i]);
    c[i] = slope[i] - slope[i - 1];
  }
  b[0] = -d[0];
  b[n - 1] = -d[n - 2];
  if (n > 3) {
    const double first = c[2] / (x[3] - x[1]) - c[1] / (x[2] - x[0]);
    const double last = c[n - 2] / (x[n - 1] - x[n - 3]) - c[n - 3] / (x[n - 2] - x[n - 4]);
    c[0] = first * d[0] * d[0] / (x[3] - x[0]);
    c[n - 1] = -last * d[n - 2] * d[n - 2] / (x[n - 1] - x[n - 4]);
  }
  for (std::size_t i = 1; i < n; ++i) {
    const double t = d[i - 1] / b[i - 1];
    b[i] -= t * d[i - 1];
    c[i] -= t * c[i - 1];
  }
  c[n - 1] /= b[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) c[i] = (c[i] - d[i] * c[i + 1]) / b[i];
  b[n - 1] = slope[n - 2] + d[n - 2] * (c[n - 2] + 2 * c[n - 1]);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    b[i] = slope[i] - d[i] * (c[i + 1] + 2 * c[i]);
    d[i] = (c[i + 1] - c[i]) / d[i];
  }
  for (double& value : c) value *= 3;
  result.function_ = Spline{std::move(x), std::move(y), std::move(b), std::move(c), std::move(d)};
  return result;
}

CoordinateFunction CoordinateFunction::times(double factor) const {
  CoordinateFunction result = *this;
  result.factor_ *= factor;
  return result;
}

double CoordinateFunction::value(double x) const {
  if (const auto* powers = std::get_if<std::vector<double>>(&function_)) {
    double sum = 0;
    for (std::size_t i = powers->size(); i-- > 0;) sum = sum * x + (*powers)[i];
    return factor_ * sum;
  }
  const Spline& s = std::get<Spline>(function_);
  if (x <= s.x.front()) return factor_ * (s.y.front() + (x - s.x.front()) * s.b.front());
  if (x >= s.x.back()) return factor_ * (s.y.back() + (x - s.x.back()) * s.b.back());
  const auto i = static_cast<std::size_t>(std::upper_bound(s.x.begin(), s.x.end(), x) - s.x.begin()) - 1;
  const double t = x - s.x[i];
  return factor_ * (s.y[i] + t * (s.b[i] + t * (s.c[i] + t * s.d[i])));
}

double CoordinateFunction::slope(double x) const {
  if (const auto* powers = std::get_if<std::vector<double>>(&function_)) {
    double sum = 0;
    for (std::size_t i = powers->size(); i-- > 1;) sum = sum * x + static_cast<double>(i) * (*powers)[i];
    return factor_ * sum;
  }
  const Spline& s = std::get<Spline>(function_);
  if (x <= s.x.front()) return factor_ * s.b.front();
  if (x >= s.x.back()) return factor_ * s.b.back();
  const auto i = static_cast<std::size_t>(std::upper_bound(s.x.begin(), s.x.end(), x) - s.x.begin()) - 1;
  const double t = x - s.x[i];
  return factor_ * (s.b[i] + t * (2 * s.c[i] + 3 * t * s.d[i]));
}

double CoordinateFunction::curvature(double x) const {
  if (const auto* powers = std::get_if<std::vector<double>>(&function_)) {
    double sum = 0;
    for (std::size_t i = powers->size(); i-- > 2;) sum = sum * x + static_cast<double>(i * (i - 1)) * (*powers)[i];
    return factor_ * sum;
  }
  const Spline& s = std::get<Spline>(function_);
  if (x <= s.x.front() || x >= s.x.back()) return 0;
  const auto i = static_cast<std::size_t>(std::upper_bound(s.x.begin(), s.x.end(), x) - s.x.begin()) - 1;
  return factor_ * (2 * s.c[i] + 6 * (x - s.x[i]) * s.d[i]);
}

std::optional<std::pair<double, double>> CoordinateFunction::line() const {
  const auto* powers = std::get_if<std::vector<double>>(&function_);
  if (powers == nullptr || powers->size() > 2) return std::nullopt;
  const double offset = powers->empty() ? 0 : powers->front(), slope = powers->size() < 2 ? 0 : powers->back();
  return std::pair(factor_ * slope, factor_ * offset);
}

std::optional<int> Skeleton::segment(std::string_view required) const {
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (segments[i].name == required) return static_cast<int>(i);
  }
  return std::nullopt;
}

std::optional<int> Skeleton::coordinate(std::string_view required) const {
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (coordinates[i].name == required) return static_cast<int>(i);
  }
  return std::nullopt;
}

std::vector<double> Skeleton::rest() const {
  std::vector<double> values;
  values.reserve(coordinates.size());
  for (const Coordinate& coordinate : coordinates) values.push_back(coordinate.rest);
  couple(values);
  return values;
}

void Skeleton::couple(std::span<double> values) const {
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (const auto& coupling = coordinates[i].coupling)
      values[i] = coupling->function.value(values[static_cast<std::size_t>(coupling->to)]);
  }
}

std::string_view kind_of(const Skeleton& skeleton, const Joint& joint) {
  int rotations = 0, shifts = 0;
  for (const JointAxis& axis : joint.axes) {
    if (!axis.coordinate) continue;
    const auto line = axis.amount.line();
    const Coordinate& coordinate = skeleton.coordinates[static_cast<std::size_t>(*axis.coordinate)];
    if (!line || coordinate.coupling || coordinate.is_rotation != axis.is_rotation) return "custom";
    if (line->first == 0 || coordinate.locked) continue;
    ++(axis.is_rotation ? rotations : shifts);
  }
  if (shifts == 3 && rotations == 3) return "free";
  if (shifts > 0) return "custom";
  constexpr std::array<std::string_view, 4> kinds = {"weld", "hinge", "universal", "ball"};
  return rotations <= 3 ? kinds[static_cast<std::size_t>(rotations)] : "custom";
}

std::vector<Rigid3> pose_of(const Skeleton& skeleton, std::span<const double> coordinates) {
  std::vector<Rigid3> world_from(skeleton.segments.size());
  for (std::size_t i = 0; i < skeleton.segments.size(); ++i) {
    const Segment& segment = skeleton.segments[i];
    Rigid3 parent_from = segment.joint.parent_from_joint;
    for (const JointAxis& axis : segment.joint.axes) {
      const double x = axis.coordinate ? coordinates[static_cast<std::size_t>(*axis.coordinate)] : 0;
      parent_from = parent_from * moved_along(axis, axis.amount.value(x));
    }
    parent_from = parent_from * segment.joint.joint_from_segment;
    world_from[i] = segment.parent ? world_from[static_cast<std::size_t>(*segment.parent)] * parent_from : parent_from;
  }
  return world_from;
}

Vector<3> rotations_about(const Matrix<3>& rotation, const Matrix<3>& axes, const Vector<3>& near) {
  // Seen along its own axes, which may be left-handed, every turn is one about x, y or z.
  const double hand = axes.determinant() < 0 ? -1 : 1;
  const Matrix<3> r = axes.transpose() * rotation * axes;
  const double cosine = std::hypot(r(0, 0), r(0, 1));
  Vector<3> first, second;
  first[1] = std::atan2(r(0, 2), cosine);
  if (cosine < 1e-9) {
    first[0] = hand * near[0];
    const double sine = std::sin(first[0]), of_first = std::cos(first[0]);
    first[2] = std::atan2(of_first * r(1, 0) + sine * r(2, 0), of_first * r(1, 1) + sine * r(2, 1));
    second = first;
  } else {
    first[0] = std::atan2(-r(1, 2), r(2, 2));
    first[2] = std::atan2(-r(0, 1), r(0, 0));
    second = {first[0] + std::numbers::pi, std::numbers::pi - first[1], first[2] + std::numbers::pi};
  }
  for (int i = 0; i < 3; ++i) {
    first[i] = unwound(hand * first[i], near[i]);
    second[i] = unwound(hand * second[i], near[i]);
  }
  return (second - near).squaredNorm() < (first - near).squaredNorm() ? second : first;
}

std::vector<Matrix<3>> rest_of(const Skeleton& skeleton) {
  const std::vector<double> rest = skeleton.rest();
  std::vector<Matrix<3>> rotated;
  for (const Rigid3& pose : pose_of(skeleton, rest)) rotated.push_back(pose.rotation);
  return rotated;
}

Rigid3 body_pose(const Rigid3& world_from_segment, const Matrix<3>& rest) {
  return {world_from_segment.rotation * rest.transpose(), world_from_segment.translation};
}

std::vector<Body> bodies_of(const Skeleton& skeleton) {
  const std::vector<Rigid3> rest = pose_of(skeleton, skeleton.rest());
  std::vector<Body> bodies(skeleton.segments.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Segment& segment = skeleton.segments[i];
    Body& body = bodies[i];
    body.id = BodyId(static_cast<int>(i) + 1);
    body.label = segment.name;
    body.skeleton = skeleton.name.empty() ? "skeleton" : skeleton.name;
    if (segment.parent) {
      body.parent = BodyId(*segment.parent + 1);
      body.offset = rest[i].translation - rest[static_cast<std::size_t>(*segment.parent)].translation;
    }
    if (segment.end) body.end = rest[i].rotation * *segment.end;
  }
  for (const SkeletonMarker& marker : skeleton.markers) {
    const auto on = static_cast<std::size_t>(marker.segment);
    bodies[on].markers.push_back({marker.label, rest[on].rotation * marker.position});
  }
  return bodies;
}

}  // namespace marey
