#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "marey/pipeline/take/edit_take.h"

namespace marey::viewer {

/// What a page asks of a take: a word, how the take's edits stood as the page shows them, and what to do.
///   edit HEAD NEWEST TEXT        TEXT as `marey edit` takes it: "swap LKNE RKNE 120:180"
///   undo HEAD NEWEST             redo HEAD NEWEST             go HEAD NEWEST ID
struct EditMessage {
  enum class Kind { edit, undo, redo, go };

  Kind kind{};
  pipeline::take::EditState on;
  std::string text = {};  ///< of `edit`
  std::int64_t to = 0;    ///< of `go`; 0: as it was recorded
};

/// Nothing if the line is not one of these, the one who wrote it.
std::optional<EditMessage> edit_message(std::string_view line);

/// Whether a line begins as one does.
bool queries_for_edit(std::string_view line);

}  // namespace marey::viewer
