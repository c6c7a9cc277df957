#pragma once

#include <string>

#include "marey/core/marker_set.h"

namespace marey::format::motion {

/// Reads a marker set: CSV with the header `label,x,y,z` and a line for each marker, in m; or plain text with one name a line.
/// Blank lines and those that begin with # do not count. Throws Error, `path:LINE: …`, for what is neither, and for a name that
/// occurs twice.
MarkerSet read_marker_set(const std::string& path);

}  // namespace marey::format::motion
