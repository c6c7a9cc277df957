#pragma once

#include "marey/edit/operation.h"
#include "marey/edit/request.h"
#include "marey/edit/tracks.h"

namespace marey::edit {

/// What a request means for these tracks: names become tracks, and what is left to the program (how each gap is filled, how
/// strongly each path is smoothed) is decided now, so that replaying decides nothing. Throws Error where a track is not there, a
/// name means several, or there is nothing to be done.
Operation decide(const Request& request, Tracks& tracks);

}  // namespace marey::edit
