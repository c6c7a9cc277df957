#pragma once

#include <string>

#include "marey/core/picture.h"

namespace marey::draw {

/// Writes one picture, whole or not at all: JPEG where `path` ends in .jpg or .jpeg, else PNG. Throws Error where that cannot be.
void write_picture(const std::string& path, const Picture& picture);

}  // namespace marey::draw
