#pragma once

#include <string>

#include "marey/format/tracks/mot.h"

namespace marey::format::tracks {

/// The boxes of tracks in an image, from a file of any format that holds such: MOTChallenge text as `read_mot` takes it, also from
/// standard input ("-"), CSV, JSON lines, a take. Throws Error if it holds something else.
MotTable read_boxes(const std::string& path, MotKind kind);

}  // namespace marey::format::tracks
