#pragma once

#include <functional>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/simulate/people/sprites.h"

namespace marey::simulate::people {

/// Where a pixel of the image lies in the image of the camera at rest, px.
using PixelMap = std::function<Vector<2>(const Vector<2>&)>;

/// What a camera sees that moves while the shutter is open: the mean of `planes` as seen at the instants of `moments`. `planes`
/// reach `margin` px, an even number, beyond the image on each side; what comes back is the image's size. Pre: there is a
/// instant.
Planes exposed(const Planes& planes, const std::vector<PixelMap>& time_steps, int margin);

}  // namespace marey::simulate::people
