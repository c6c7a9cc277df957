#pragma once

#include <cmath>

namespace marey::geometry {

/// Probability that a chi-square variable with `degrees` ≥ 1 degrees of freedom exceeds x ≥ 0. Abramowitz & Stegun 26.4.8.
inline double chi_square_tail(int degrees, double x) {
  const bool odd = degrees % 2 == 1;
  double tail = odd ? std::erfc(std::sqrt(x / 2)) : std::exp(-x / 2);
  for (int k = odd ? 3 : 4; k <= degrees; k += 2) {
    tail += std::pow(x / 2, k / 2.0 - 1) * std::exp(-x / 2) / std::tgamma(k / 2.0);
  }
  return tail;
}

/// The x that a chi-square variable stays below with probability p in (0, 1). By bisection, to rounding: not for inner loops.
inline double chi_square_quantile(int degrees, double p) {
  double low = 0;
  double high = 1;
  while (chi_square_tail(degrees, high) > 1 - p) high *= 2;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (chi_square_tail(degrees, middle) > 1 - p ? low : high) = middle;
  }
  return high;
}

}  // namespace marey::geometry
