#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "marey/core/geometry.h"

namespace marey::simulate {

/// Random numbers that are the same on every machine and standard library: the engine is fixed by the C++ standard, and the
/// distributions, which it leaves open, are ours.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [low, high).
  double uniform(double low = 0.0, double high = 1.0) { return low + (high - low) * unit(); }

  /// Uniform over the integers low … high, both included.
  int integer(int low, int high) { return low + static_cast<int>(unit() * (static_cast<double>(high) - low + 1)); }

  /// Gaussian with the given mean and standard deviation (Box & Muller 1958).
  double gaussian(double mean = 0.0, double sigma = 1.0) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - unit()));
    return mean + sigma * radius * std::cos(2.0 * std::numbers::pi * unit());
  }

  /// Two, the second drawn first. As arguments of one call they would be drawn in an order that each compiler chooses.
  Vector<2> gaussian_pair(double sigma = 1.0) {
    const double second = gaussian(0, sigma), first = gaussian(0, sigma);
    return {first, second};
  }
  Vector<2> uniform_pair(double low_x, double high_x, double low_y, double high_y) {
    const double second = uniform(low_y, high_y), first = uniform(low_x, high_x);
    return {first, second};
  }

  bool chance(double probability) { return unit() < probability; }

 private:
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }

  std::mt19937_64 engine_;
};

}  // namespace marey::simulate
