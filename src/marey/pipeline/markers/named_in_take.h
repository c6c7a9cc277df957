#pragma once

#include <string>

#include "marey/core/marker_set.h"

namespace marey::pipeline::markers {

/// The names that a take gave its markers, and how they lay at the moment of its first second that has most of them: for who solves
/// it again, or plays it as its cameras. Empty if the file is not a take, or has no names.
MarkerSet named_in_take(const std::string& path);

}  // namespace marey::pipeline::markers
