#pragma once

#include <string>

#include "marey/edit/fill_gap.h"
#include "marey/edit/operation.h"
#include "marey/edit/request.h"
#include "marey/edit/tracks.h"

namespace marey::edit {

/// What a request means for these tracks: names become tracks, and the rest to the program (how each gap is filled, how
/// strongly each path is smoothed) is decided now, so that replaying decides nothing. Throws Error if a track is not there, a
/// name means several, or there is nothing to be done. With `open`, which gets the gaps that a fill leaves open, a fill without
/// a gap that it can fill is not an Error but an operation without gaps.
Operation decide(const Request& request, Tracks& tracks, OpenGaps* open = nullptr);

/// "2 gaps stay open: 1 longer than 1 s, …"; that no gap is left, if so.
std::string words_of(const OpenGaps& open, const Request& request);

}  // namespace marey::edit
