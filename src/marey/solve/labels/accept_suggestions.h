#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "marey/solve/labels/label_recording.h"

namespace marey::solve::labels {

/// Gives pieces without a name the one that fits them best, the longest piece first, where it is one of `names` (all, where there
/// are not any) and no other point has it then. They count as seen from then on. How many got one.
std::int64_t accept_suggestions(Labelled& labelled, const std::vector<std::string>& names);

}  // namespace marey::solve::labels
