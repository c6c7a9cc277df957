#pragma once

#include <cstddef>
#include <vector>

#include "marey/detect/markers/marker_fit.h"

namespace marey::detect::markers {

/// Markers that touch or overlap and so form one blob: their shapes, left to right and then top to bottom; empty where the blob is
/// better told as one marker, round or drawn out by its motion. `expected`: how many markers the tracker expects in the blob; two
/// or more make splitting likelier. At most four.
std::vector<MarkerShape> split_markers(const MarkerWindow& window, const MarkerBlob& blob, const MarkerSurroundings& around,
                                       std::size_t expected = 0);

}  // namespace marey::detect::markers
