#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/detect/background/background_regions.h"

namespace marey::detect::background {

/// Writes 1 into `row`, which is as long as the rows [top, bottom] or longer, where one of `held` lies.
void mark_held(std::span<const Box> held, int top, int bottom, int width, std::vector<std::uint8_t>& row);

/// Marks the pixels of rows [top, bottom] that must not be learned: regions with their rims, and held boxes. The rest of `row`
/// becomes 0.
void mark_frozen(const ForegroundRegions& regions, std::span<const Box> held, int top, int bottom, cv::Size size,
                 std::vector<std::uint8_t>& row);

}  // namespace marey::detect::background
