// The edits of a recording form a tree: each follows its parent. The head says which branch counts.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "marey/core/recording.h"

namespace marey::edit {

/// What counts: the edits from the first to `head`, in the order they were made. Throws Error if the head is not an edit, or an
/// edit follows none that was made before it.
std::vector<Edit> branch_of(const std::vector<Edit>& edits, std::optional<std::int64_t> head);

/// The head `steps` edits before, at most before all of them.
std::optional<std::int64_t> undone(const std::vector<Edit>& edits, std::optional<std::int64_t> head, std::int64_t steps);

/// The head `steps` edits on, each time to the one that was made last after it; as far as there are any.
std::optional<std::int64_t> redone(const std::vector<Edit>& edits, std::optional<std::int64_t> head, std::int64_t steps);

/// The id of the next edit.
std::int64_t next_id(const std::vector<Edit>& edits);

}  // namespace marey::edit
