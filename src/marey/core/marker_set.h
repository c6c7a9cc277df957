#pragma once

#include <string>
#include <vector>

#include "marey/core/geometry.h"

namespace marey {

/// The names of a take's markers, and how they lie to each other at its beginning (on a rigid body: always).
struct MarkerSet {
  std::vector<std::string> labels;
  std::vector<Vector<3>> locations;  ///< m, in any frame; one for each label, or none at all

  bool has_positions() const { return !locations.empty(); }
};

}  // namespace marey
