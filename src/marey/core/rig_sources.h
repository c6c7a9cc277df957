#pragma once

#include <span>
#include <string>

#include "marey/core/rig.h"

namespace marey {

/// Other sources than the rig's own, as given on the command line: `cam=VIDEO`; a text file (.txt, .csv) is taken for detections.
/// Throws Error for what is no such pair, a camera that is not in the rig, and one that is given twice.
void set_sources(Rig& rig, std::span<const std::string> pairs);

}  // namespace marey
