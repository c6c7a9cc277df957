#pragma once

#include <array>

#include "marey/core/appearance.h"
#include "marey/core/geometry.h"

namespace marey {

/// CIE L*a*b* (D65) of a colour in sRGB; `red`, `green`, `blue` in [0, 255], what lies outside is brought to the border. Some 50
/// ns.
std::array<float, 3> lab_from_srgb(float red, float green, float blue);

/// The nearest colour that a screen can show: red, green, blue in [0, 255].
std::array<float, 3> srgb_from_lab(float lightness, float a, float b);

/// A colour as a point in a space in which distances say how different two shirts are, whatever light and distance do to them:
/// shade changes lightness, which counts less, and a small figure's colour is thinned by what is around it, so that the strength of
/// a colour counts by its logarithm; hue counts whole. Of about the scale of L*a*b*; a deviation there is about half of it here.
Vector<3> perceived(const Appearance& colour);

/// Vice versa: the colour at a point of that space.
Appearance colour_at(const Vector<3>& point, double deviation);

}  // namespace marey
