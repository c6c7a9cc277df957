#pragma once

#include <memory>

#include "marey/core/source.h"

namespace marey::source {

/// The part `region` of every picture of `source`, in px: several cameras may lie side by side in one picture. Pixels count from
/// the region's corner. Throws Error where the region does not lie within the source's pictures; a later frame of another size is
/// left out and told of by `warnings`.
std::unique_ptr<Source> crop(std::unique_ptr<Source> source, cv::Rect region);

}  // namespace marey::source
