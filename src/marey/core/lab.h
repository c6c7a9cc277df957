#pragma once

#include <array>

namespace marey {

/// CIE L*a*b* (D65) of a colour in sRGB; `red`, `green`, `blue` in [0, 255], what lies outside is brought to the border. Some 50
/// ns.
std::array<float, 3> lab_from_srgb(float red, float green, float blue);

/// The nearest colour that a screen can show: red, green, blue in [0, 255].
std::array<float, 3> srgb_from_lab(float lightness, float a, float b);

}  // namespace marey
