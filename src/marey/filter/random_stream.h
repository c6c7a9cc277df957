#pragma once

// Random numbers for particle filters: the n-th number is a hash of the seed and n, so a stream is two integers, copies of a
// filter continue alike, and no state is shared. Hash: the finaliser of Steele, Lea, Flood, "Fast splittable pseudorandom number
// generators", OOPSLA 2014. Normal numbers by Box and Muller's transform.

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace marey::filter {

class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed) : key_(seed) {}

  std::uint64_t bits() {
    std::uint64_t x = key_ + 0x9e3779b97f4a7c15ULL * ++counter_;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
  }

  /// In (0, 1).
  double uniform() { return (static_cast<double>(bits() >> 12) + 0.5) * 0x1p-52; }

  /// Two independent normal numbers of mean 0 and variance 1.
  std::pair<double, double> normal_pair() {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    const double angle = 2 * std::numbers::pi * uniform();
    return {radius * std::cos(angle), radius * std::sin(angle)};
  }

 private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

}  // namespace marey::filter
