#include "marey/simulate/value_noise.h"

#include <cmath>

namespace marey::simulate {
namespace {

/// A random value in [−1, 1] for a corner of a grid, by mixing bits (after Steele, Lea & Flood's SplitMix64).
double corner_value(std::int64_t x, std::int64_t y, std::uint64_t seed) {
  std::uint64_t z =
      seed + static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ULL + static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FULL;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
  z ^= z >> 31U;
  return static_cast<double>(z >> 11U) * 0x1.0p-52 - 1;
}

}  // namespace

double value_noise(const Vector<2>& at, std::uint64_t seed) {
  const double fx = std::floor(at.x()), fy = std::floor(at.y());
  const auto x = static_cast<std::int64_t>(fx), y = static_cast<std::int64_t>(fy);
  const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
  const double u = smooth(at.x() - fx), v = smooth(at.y() - fy);
  const double top = (1 - u) * corner_value(x, y, seed) + u * corner_value(x + 1, y, seed);
  const double bottom = (1 - u) * corner_value(x, y + 1, seed) + u * corner_value(x + 1, y + 1, seed);
  return (1 - v) * top + v * bottom;
}

}  // namespace marey::simulate
