#pragma once

#include <memory>
#include <string>

#include "marey/core/source.h"
#include "marey/source/live/connection.h"

namespace marey::source::live {

struct KeepOptions {
  int keep = 4;                ///< frames that were not yet requested
  double first_retry_s = 0.2;  ///< after a camera was lost, or could not be opened, this long until it is tried again
  double longest_retry_s = 1;  ///< each time it fails the wait doubles, up to this
  std::shared_ptr<CameraControls> controls = {};  ///< null: nothing can be set
  double silent_s = 3;  ///< a camera that gave nothing for this long, and for three periods, is opened again
};

/// A camera that is read on a thread of its own and connected again, without end, whenever it is not there: from the first attempt
/// on. The last few frames that were not requested are kept. Times are by the run's clock, growing, from when the camera says it
/// took the frames; gaps in its numbers are counted. `name` is what messages call it.
std::unique_ptr<LiveSource> keep_connected(std::string name, Connect connect, std::shared_ptr<LiveTime> time,
                                           const KeepOptions& options = {});

}  // namespace marey::source::live
