#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/recording.h"

namespace marey::format::take {

/// Where a take's edits stand: what is decided on them counts only as long as they stand there.
struct EditState {
  std::int64_t head = 0;    ///< the edit up to which they count; 0: none does
  std::int64_t newest = 0;  ///< the largest id; 0: no edits

  bool operator==(const EditState&) const = default;
};

EditState edit_state(const std::vector<Edit>& edits, std::optional<std::int64_t> head);

/// Adds edits to a take that is there and says which one counts, all of it or nothing; the recording is not touched. Throws
/// Error where it is not a take, is still being recorded, was written by a version of Marey before edits could be replayed, or
/// cannot be written; and where its edits no longer stand at `on`, for then another program has edited it in the meantime.
void add_edits(const std::string& path, std::span<const Edit> more, std::optional<std::int64_t> head, const EditState& on);
/// Throws that Error.
[[noreturn]] void fail_edited_elsewhere(const std::string& path);

}  // namespace marey::format::take
