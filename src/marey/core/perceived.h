#pragma once

#include <cmath>

#include "marey/core/appearance.h"
#include "marey/core/geometry.h"

namespace marey {

/// A colour as a point in a space in which distances say how different two shirts are, whatever light and distance do to them:
/// shade changes lightness, which counts less, and a small figure's colour is thinned by what is around it, so that the strength of
/// a colour counts by its logarithm; hue counts whole. Of about the scale of L*a*b*; a deviation there is about half of it here.
inline Vector<3> perceived(const Appearance& colour) {
  constexpr double lightness_counts = 0.6;
  constexpr double weak = 30;  // chroma up to which strength counts nearly whole
  const double chroma = std::hypot(static_cast<double>(colour.a), static_cast<double>(colour.b));
  const double kept = chroma > 1e-6 ? weak * std::log1p(chroma / weak) / chroma : 1;
  return {lightness_counts * colour.lightness, kept * colour.a, kept * colour.b};
}

/// The other way round.
inline Appearance colour_at(const Vector<3>& point, double deviation) {
  constexpr double weak = 30;
  const double kept = std::hypot(point[1], point[2]);
  const double chroma = kept > 1e-6 ? weak * std::expm1(kept / weak) / kept : 1;
  return {.lightness = static_cast<float>(point[0] / 0.6),
          .a = static_cast<float>(chroma * point[1]),
          .b = static_cast<float>(chroma * point[2]),
          .deviation = static_cast<float>(deviation)};
}

}  // namespace marey
