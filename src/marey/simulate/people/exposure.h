#pragma once

#include <functional>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/simulate/people/sprites.h"

namespace marey::simulate::people {

/// Where a pixel of the picture lies in the picture of the camera at rest, px.
using PixelMap = std::function<Vector<2>(const Vector<2>&)>;

/// What a camera sees that moves while the shutter is open: the mean of `planes` as seen at the moments of `moments`. `planes`
/// reach `margin` px, an even number, beyond the picture on each side; what comes back is the picture's size. Pre: there is a
/// moment.
Planes exposed(const Planes& planes, const std::vector<PixelMap>& moments, int margin);

}  // namespace marey::simulate::people
