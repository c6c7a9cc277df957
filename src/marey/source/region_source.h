#pragma once

#include <memory>

#include "marey/core/source.h"

namespace marey::source {

/// The part `region` of every image of `source`, in px: several cameras may lie side by side in one image. Pixels count from
/// the region's corner. Throws Error if the region does not lie within the source's images; a later frame of another size is
/// omitted and reported of by `warnings`.
std::unique_ptr<Source> crop(std::unique_ptr<Source> source, cv::Rect region);

}  // namespace marey::source
