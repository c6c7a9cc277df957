#pragma once

#include <optional>
#include <string>

#include "marey/pipeline/corridor/run.h"

namespace marey::pipeline::people {

/// Why a search for people has nobody in its results, one sentence; nothing where it has somebody. By what `summary` counts.
std::optional<std::string> why_nobody(const corridor::Summary& summary);

}  // namespace marey::pipeline::people
