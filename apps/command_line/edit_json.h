#pragma once

#include "marey/pipeline/take/describe_edits.h"

#include "json_value.h"

namespace marey::cli {

/// One edit for programs: its number, what it was and did, the gaps that it filled.
Json edit_json(const pipeline::take::EditLine& line);

}  // namespace marey::cli
