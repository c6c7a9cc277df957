#pragma once

namespace marey {

/// What distinguishes one person from another at a glance: the colour of the clothes on the upper body, in CIE L*a*b* (D65).
struct Appearance {
  float lightness = 0;   ///< L*, in [0, 100]; like a* and b* the median of the pixels
  float a = 0, b = 0;    ///< green to red, blue to yellow: about [-100, 100]
  float deviation = 10;  ///< standard deviation of each component, from the pixels' spread and their number
};

}  // namespace marey
