#pragma once

#include "marey/core/geometry.h"
#include "marey/geometry/pitch.h"

namespace marey::draw {

/// Where a pitch is in the coordinates of what is drawn on it.
struct PitchFrame {
  geometry::PitchSize size = {};
  Vector<2> corner = Vector<2>::Zero();  ///< m: its own with the least x and y
  bool y_down = false;                   ///< else y grows upwards; see core/ground_transform.h
};

}  // namespace marey::draw
