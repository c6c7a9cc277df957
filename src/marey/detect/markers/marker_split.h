#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "marey/detect/markers/marker_fit.h"

namespace marey::detect::markers {

/// How a blob that is not a disc is best explained.
struct MarkerSplit {
  std::vector<MarkerShape> discs;    ///< two to four that touch or overlap, left to right and then top to bottom; or none
  std::optional<MarkerShape> swept;  ///< without them: one that moved while it was seen, whose radius is half the streak's width
};

/// Explains a blob as several markers or as one drawn out by its motion, where one of these is as good as what a lone disc leaves
/// of a marker. `expected`: how many markers the tracker expects in the blob; two make a split more likely. `window` is the blob's.
/// `moving`: others in the image are drawn out by their motion, so that two that touch may be.
MarkerSplit split_markers(const MarkerWindow& window, const MarkerBlob& blob, const MarkerSurroundings& around,
                          std::size_t expected, bool moving);

}  // namespace marey::detect::markers
