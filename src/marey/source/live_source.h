#pragma once

#include <memory>

#include "marey/core/source.h"
#include "marey/source/live_time.h"

namespace marey::source {

/// A source that waits for its camera, read on a thread of its own: the last `keep` frames that nobody asked for are kept. Frames'
/// times go on as the source has them, from when the first one came. The source must end its waiting when it is asked to
/// (core/stop.h): its reader ends with the result.
std::unique_ptr<LiveSource> read_live(std::unique_ptr<Source> source, std::shared_ptr<LiveTime> time, int keep = 4);

}  // namespace marey::source
