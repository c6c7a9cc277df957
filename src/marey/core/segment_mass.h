// What a segment weighs, for dynamics.
#pragma once

#include "marey/core/geometry.h"

namespace marey {

/// Of one segment, in its own frame.
struct SegmentMass {
  double mass_kg = 0;
  Vector<3> centre = Vector<3>::Zero();   ///< m
  Matrix<3> inertia = Matrix<3>::Zero();  ///< kg m², about the centre
};

}  // namespace marey
