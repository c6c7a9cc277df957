// Prints a closed spline in full precision, for splines_test.py to compare with another program.
//
//   spline_points ORDER COUNT SEED
//
// First line: the control points, x y each. Second: area, centroid x y, length. Then a line for each of many parameters:
//   u | point | derivative
#include <cstdlib>
#include <vector>

#include <fmt/core.h>

#include "marey/core/geometry.h"
#include "marey/geometry/bspline.h"
#include "marey/simulate/random.h"

int main(int argc, char** argv) {
  if (argc != 4) {
    fmt::print(stderr, "usage: spline_points ORDER COUNT SEED\n");
    return 2;
  }
  const int order = std::atoi(argv[1]), count = std::atoi(argv[2]);
  if (order < 2 || order > marey::geometry::SplineWeights::max_order || count < order || count < 3) return 2;
  marey::simulate::Random random(std::strtoull(argv[3], nullptr, 10));
  std::vector<marey::Vector<2>> points;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(0, 100);
    points.emplace_back(x, random.uniform(0, 100));
  }
  const marey::geometry::ClosedSpline spline(order, points);
  for (const auto& point : points) fmt::print("{:.17g} {:.17g} ", point.x(), point.y());
  fmt::print("\n{:.17g} {:.17g} {:.17g} {:.17g}\n", spline.area(), spline.centroid().x(), spline.centroid().y(), spline.length());
  for (int i = 0; i < 40 * count; ++i) {
    const double u = i / 40.0;
    const auto at = spline.at(u), slope = spline.derivative(u);
    fmt::print("{:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", u, at.x(), at.y(), slope.x(), slope.y());
  }
  return 0;
}
