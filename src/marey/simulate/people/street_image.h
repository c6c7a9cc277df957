#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "marey/core/image.h"

namespace marey::simulate::people {

/// A house front with windows, doors and shutters above a pavement of slabs with a kerb: full of edges, as most places are where
/// cameras hang. Colour, limited range, `size` px; the pavement begins at 0.4 of the height. The same for the same seed.
Image draw_street(cv::Size size, std::uint64_t seed);

}  // namespace marey::simulate::people
