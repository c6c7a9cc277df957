// Butterworth's low pass of second order, run forwards and backwards over a path at an even rate, so that nothing lags: together of
// fourth order. The ends are continued point-symmetrically, so that what moves does so beyond them too.
// Source: Winter, "Biomechanics and Motor Control of Human Movement", section 2.2.4.4 (the cut-off of two passes).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

namespace marey::geometry {

/// y[i] = b0 x[i] + b1 x[i − 1] + b2 x[i − 2] − a1 y[i − 1] − a2 y[i − 2]
struct Butterworth {
  double b0, b1, b2, a1, a2;

  /// By the bilinear transform, its frequency corrected. `cutoff` as a share of the rate, in (0, ½).
  explicit Butterworth(double cutoff) {
    const double w = std::tan(std::numbers::pi * cutoff), root = std::numbers::sqrt2 * w, n = 1 / (1 + root + w * w);
    b0 = b2 = w * w * n;
    b1 = 2 * w * w * n;
    a1 = 2 * (w * w - 1) * n;
    a2 = (1 - root + w * w) * n;
  }

  /// Once over the values, as if the first had been there for ever.
  template <typename Value>
  void pass(std::span<Value> values) const {
    Value x1 = values.front(), x2 = x1, y1 = x1, y2 = x1;
    for (Value& value : values) {
      const Value y = b0 * value + b1 * x1 + b2 * x2 - a1 * y1 - a2 * y2;
      x2 = x1, x1 = value, y2 = y1, y1 = y;
      value = y;
    }
  }
};

/// The cut-off of each pass, where both together are to let half of the power through at `cutoff_hz`.
inline double cutoff_of_one_pass(double cutoff_hz) {
  return cutoff_hz / std::pow(std::numbers::sqrt2 - 1, 0.25);
}

/// Smooths values (numbers or vectors) at an even rate by two passes, each with this cut-off as a share of the rate, in (0, ½).
/// `margin` values are added at each end, as far as there are as many.
template <typename Value>
void low_pass(std::span<Value> values, double cutoff, std::size_t margin) {
  if (values.size() < 2) return;
  margin = std::min(margin, values.size() - 1);
  std::vector<Value> wide;
  wide.reserve(values.size() + 2 * margin);
  for (std::size_t i = margin; i > 0; --i) wide.push_back(2 * values.front() - values[i]);
  wide.insert(wide.end(), values.begin(), values.end());
  for (std::size_t i = 1; i <= margin; ++i) wide.push_back(2 * values.back() - values[values.size() - 1 - i]);
  const Butterworth filter(cutoff);
  for (int pass = 0; pass < 2; ++pass) {
    filter.pass(std::span<Value>(wide));
    std::reverse(wide.begin(), wide.end());
  }
  std::copy_n(wide.begin() + static_cast<std::ptrdiff_t>(margin), values.size(), values.begin());
}

}  // namespace marey::geometry
