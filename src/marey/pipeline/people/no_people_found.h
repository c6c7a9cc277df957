#pragma once

#include <optional>
#include <string>

#include "marey/pipeline/corridor/run.h"

namespace marey::pipeline::people {

/// Why a search for people has no person in its results, one sentence; nothing if it has a person. By what `summary` counts.
std::optional<std::string> why_none(const corridor::Summary& summary);

}  // namespace marey::pipeline::people
