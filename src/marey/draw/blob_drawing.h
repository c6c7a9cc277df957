#pragma once

#include <span>

#include "marey/core/detection.h"
#include "marey/core/image.h"

namespace marey::draw {

/// The image with a ring round each blob and a dot at its centre: bright green where the detector is sure (score of a half and
/// more), orange where it is not. Grey levels beyond 8 bits are scaled so that the brightest is white.
Image draw_blobs(const Image& image, std::span<const Detection> blobs);

}  // namespace marey::draw
