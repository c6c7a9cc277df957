#pragma once

#include <algorithm>
#include <cmath>

namespace marey::source {

/// Whether two rates, Hz, are not the same camera's: 29.97 and 30 are, 59.94 and 50 are not.
inline bool differ(double one, double other) {
  constexpr double kRounding = 0.02;
  return std::abs(one - other) > kRounding * std::max(one, other);
}

}  // namespace marey::source
