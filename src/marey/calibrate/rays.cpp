#include "marey/calibrate/rays.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace marey::calibrate {

double angle_off(const SightLine& line, const Vector<3>& point) {
  const Vector<3> to = point - line.ray.origin;
  return std::atan2(line.ray.direction.cross(to).norm(), line.ray.direction.dot(to)) / line.sigma;
}

std::optional<Vector<3>> intersection_point(std::span<const SightLine> lines) {
  if (lines.size() < 2) return std::nullopt;
  std::optional<Vector<3>> point;
  for (int pass = 0; pass < 2; ++pass) {  // the second time distances weigh as the angles they are
    Matrix<3> normal = Matrix<3>::Zero();
    Vector<3> right = Vector<3>::Zero();
    for (const SightLine& line : lines) {
      const double reach = point ? std::max(1e-9, (*point - line.ray.origin).norm()) * line.sigma : line.sigma;
      const Matrix<3> across = (Matrix<3>::Identity() - line.ray.direction * line.ray.direction.transpose()) / (reach * reach);
      normal += across;
      right += across * line.ray.origin;
    }
    const Eigen::LDLT<Matrix<3>> solver(normal);
    if (!solver.isPositive() || solver.rcond() < 1e-9) return std::nullopt;
    point = solver.solve(right);
  }
  for (const SightLine& line : lines) {
    if ((*point - line.ray.origin).dot(line.ray.direction) <= 0) return std::nullopt;
  }
  return point;
}

std::optional<Vector<3>> agreed_point(std::span<const SightLine> lines, double gate) {
  const auto agreeing = [&](const Vector<3>& point) {
    std::vector<SightLine> near;
    std::copy_if(lines.begin(), lines.end(), std::back_inserter(near),
                 [&](const SightLine& line) { return angle_off(line, point) <= gate; });
    return near;
  };
  const auto all = intersection_point(lines);
  if (all && agreeing(*all).size() == lines.size()) return all;
  std::vector<SightLine> best;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = i + 1; j < lines.size(); ++j) {
      const auto point = intersection_point(std::array{lines[i], lines[j]});
      if (!point) continue;
      auto near = agreeing(*point);
      if (near.size() > best.size()) best = std::move(near);
    }
  }
  // Two rays of many that happen to meet are not agreement.
  if (best.size() < 2 || 2 * best.size() < lines.size()) return std::nullopt;
  return intersection_point(best);
}

}  // namespace marey::calibrate
