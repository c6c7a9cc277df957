#pragma once

#include <string>
#include <vector>

#include "marey/core/geometry.h"

namespace marey::format::motion {

/// The names of a take's markers, and how they lie to each other at its beginning (on a rigid body: always).
struct MarkerSet {
  std::vector<std::string> labels;
  std::vector<Vector<3>> places;  ///< m, in any frame; one for each label, or none at all

  bool has_places() const { return !places.empty(); }
};

/// Reads a marker set: CSV with the header `label,x,y,z` and a line for each marker, in m; or plain text with one name a line.
/// Blank lines and those that begin with # do not count. Throws Error, `path:LINE: …`, for what is neither, and for a name that
/// occurs twice.
MarkerSet read_marker_set(const std::string& path);

}  // namespace marey::format::motion
