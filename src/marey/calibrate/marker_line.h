#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "marey/core/geometry.h"

namespace marey::calibrate {

/// Markers on a rigid line, as a wand has them: their distances from the first, growing, m. One marker, at 0, is a single point: a
/// light, or a point of a person's body.
struct MarkerLine {
  static constexpr std::size_t maximum = 3;

  std::vector<double> distances{0};

  std::size_t markers() const { return distances.size(); }
  double length() const { return distances.back(); }
  /// Turned end for end it appears the same: which end is which has to come from elsewhere.
  bool reversible() const;
};

/// The markers in one view, px; all of them at first, later those that were found.
using Marks = std::array<std::optional<Vector<2>>, MarkerLine::maximum>;

}  // namespace marey::calibrate
