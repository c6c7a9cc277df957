#pragma once

#include "marey/geometry/vector.h"

namespace marey {

/// What tells one person from another at a glance: the colour of the clothes on the upper body.
struct Appearance {
  Vector<3> colour =
      Vector<3>::Zero();  ///< CIE L*a*b* (D65): L* in [0, 100], a* and b* about [-100, 100]; the median of the pixels
  double deviation = 10;  ///< standard deviation of each component, from the pixels' spread and their number
};

}  // namespace marey
