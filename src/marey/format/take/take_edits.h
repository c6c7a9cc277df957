#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "marey/core/recording.h"

namespace marey::format::take {

/// Adds edits to a take that is there and says which one counts, all of it or nothing; what was recorded is not touched. Throws
/// Error where it is no take, is still being recorded, was written by a version of Marey before edits could be replayed, or cannot
/// be written.
void add_edits(const std::string& path, std::span<const Edit> more, std::optional<std::int64_t> head);

}  // namespace marey::format::take
