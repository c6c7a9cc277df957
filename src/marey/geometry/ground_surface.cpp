#include "marey/geometry/ground_surface.h"

namespace marey::geometry {

double GroundSurface::height(const Vector<2>& location) const {
  if (flat()) return 0;
  const std::array<double, kTerms> t = terms();
  return height_at(relative(location), t.data());
}

Vector<2> GroundSurface::slope(const Vector<2>& location) const {
  if (flat()) return Vector<2>::Zero();
  const Vector<2> at = relative(location);
  const auto steepness = [&](double t) {
    if (std::abs(t) >= kMaxDistance) return 0.0;
    const double of_roof = t / std::sqrt(t * t + kRound * kRound) / (std::sqrt(1 + kRound * kRound) - kRound);
    return 2 * t + ridge * (of_roof - 2 * t);
  };
  const double u = 1 - profile(at.x(), ridge), v = 1 - profile(at.y(), ridge);
  return {-steepness(at.x()) * (along + dome * v) / half.x(), -steepness(at.y()) * (across + dome * u) / half.y()};
}

}  // namespace marey::geometry
