#pragma once

#include <memory>
#include <optional>
#include <string>

#include "marey/core/source.h"

namespace marey::source {

/// Opens whatever `path` names: a video file, a folder of images, or a pattern of image names (see find_images).
/// `rate_hz`, which must be positive, overrides what the file says. Throws Error if there is nothing to be read.
std::unique_ptr<Source> open_source(const std::string& path, std::optional<double> rate_hz = std::nullopt);

}  // namespace marey::source
