#pragma once

#include <string>

#include "marey/core/image.h"

namespace marey::draw {

/// Writes one image, atomically: JPEG where `path` ends in .jpg or .jpeg, else PNG. Throws Error if that cannot be.
void write_image(const std::string& path, const Image& image);

}  // namespace marey::draw
