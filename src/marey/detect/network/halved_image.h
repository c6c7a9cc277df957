#pragma once

#include "marey/core/image.h"

namespace marey::detect::network {

/// An image of half the width and height, each pixel the mean of four: pixel p lies at 2 p + 0.5 of the given one. Its last odd row
/// and column are omitted. Nothing is converted to other colours.
Image halved(const Image& image);

}  // namespace marey::detect::network
