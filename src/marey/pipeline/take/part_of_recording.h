// The frames of a recording from one to another, with their numbers and times as they were.
#pragma once

#include <memory>
#include <string>

#include "marey/edit/operation.h"
#include "marey/format/format.h"

namespace marey::pipeline::take {

/// Passes on those frames of `reader` alone. A file's end is not reached, so that what it would warn of there is not said.
std::unique_ptr<format::FileReader> part_of(std::unique_ptr<format::FileReader> reader, const edit::FrameRange& frames);

/// The same of a recording in memory. Throws Error, with `name` for the file, where it has none of those frames.
Recording part_of(const Recording& recording, const edit::FrameRange& frames, const std::string& name);

/// Throws Error if a part that was read has no frame.
void require_frames(std::int64_t count, const edit::FrameRange& frames, const std::string& name);

}  // namespace marey::pipeline::take
