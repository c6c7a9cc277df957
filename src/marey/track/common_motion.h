#pragma once

#include <span>
#include <vector>

#include "marey/core/geometry.h"

namespace marey::track {

/// Where one target is expected, or one thing was seen, with its height: px.
struct Sighting {
  Vector<2> place = Vector<2>::Zero();
  double size = 1;
};

/// By how much everything seen lies beside where it is expected, because the camera turned or shook: px; 0 where there are too
/// few to tell or standing still explains them as well.
Vector<2> common_motion(std::span<const Sighting> expected, std::span<const Sighting> seen);

}  // namespace marey::track
