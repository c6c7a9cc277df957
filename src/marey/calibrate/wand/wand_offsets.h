// When each camera was started, by what it saw of the wand.
//
// A wand that moves fast in one view moves fast in most: the logarithms of its speed in two images, shifted against each other,
// agree best at the true shift, or near it. The shifts that agree best are tried on the two cameras' geometry (two_views): when the
// shift is right nearly all views fit. Pairs that agree most clearly come first and chain the cameras (a spanning tree). A fraction
// of a frame is left to the bundle. Cost: frames × shifts a pair, and some ten two-view relations for each of the chained pairs.
#pragma once

#include <cstdint>
#include <vector>

#include "marey/calibrate/line_placement.h"
#include "marey/calibrate/wand/wand_table.h"

namespace marey::calibrate::wand {

/// Sets the tracks' offsets, the first camera's held, where those given do not fit; leaves a camera's as it is where no shift is
/// better. True where any was changed. `cameras` by track, their lenses as good as they are known.
bool settle_offsets(std::vector<MarkTrack>& tracks, const std::vector<StartingCamera>& cameras, const MarkerLine& wand,
                    std::uint64_t seed);

}  // namespace marey::calibrate::wand
