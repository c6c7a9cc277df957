#pragma once

#include <memory>

#include "marey/core/source.h"

namespace marey::source {

/// The same source, read on a thread of its own, so that decoding and processing of frames continue side by side. At most `depth`
/// frames wait. Frames and their order do not depend on the threads.
std::unique_ptr<Source> read_ahead(std::unique_ptr<Source> source, int depth = 8);

}  // namespace marey::source
