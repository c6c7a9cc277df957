// On which side four points lie of each other: what distances alone do not specify.
#pragma once

#include <algorithm>
#include <array>

#include "marey/core/geometry.h"

namespace marey::solve::labels {

/// How far the flattest of four points stands out of the plane of the others, m; its sign is the side on which the last lies of
/// the first three, and changes where two of the four are exchanged.
inline double signed_height(const std::array<Vector<3>, 4>& locations) {
  const Vector<3> b = locations[1] - locations[0], c = locations[2] - locations[0], d = locations[3] - locations[0];
  const double widest = std::max({b.cross(c).norm(), b.cross(d).norm(), c.cross(d).norm(), (c - b).cross(d - b).norm()});
  return b.cross(c).dot(d) / std::max(widest, 1e-9);
}

}  // namespace marey::solve::labels
