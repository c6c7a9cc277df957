// Filling a gap in a marker's path: the method is chosen by trying each on holes of the same length, cut into known parts of the
// same marker round about; how far it was off there is what the fill is expected to be off.
#pragma once

#include <optional>
#include <vector>

#include "marey/edit/operation.h"
#include "marey/edit/tracks.h"

namespace marey::edit {

struct FillOptions {
  std::optional<FillMethod> method = {};  ///< nothing: the one that did best
  double longest_s = 1;                   ///< longer gaps stay open
  double within_m = 0.05;                 ///< so do gaps whose fill is expected to be farther off
};

/// Gaps that stay open, by why.
struct OpenGaps {
  int too_long = 0, too_far_off = 0;
  int unreported = 0;  ///< no method could say anything

  int all() const { return too_long + too_far_off + unreported; }
};

/// The gaps of a track between its first and its last place, within `frames`, that can be filled, and how. What other tracks have
/// filled or predicted gives nothing. `open` counts those that stay open, too.
std::vector<FilledGap> decide_fills(Tracks& tracks, TrackId track, const std::optional<FrameRange>& frames,
                                    const FillOptions& options, OpenGaps* open = nullptr);

/// The rows of a gap, filled as was decided; other tracks are asked only where the edit does not keep its places. Throws Error
/// where what it was decided on is not there any more.
Tracks::Rows rows_in_gap(Tracks& tracks, const FilledGap& gap);

}  // namespace marey::edit
