#pragma once

#include <cstdint>

#include "marey/core/ids.h"
#include "marey/core/image.h"
#include "marey/core/time.h"

namespace marey {

/// One image of one camera. `image` is empty if detections come from another program.
struct Frame {
  CameraId camera{};
  std::int64_t index = 0;  ///< counts from 0 in the order the source gave the frames
  Timestamp time{};        ///< by the source's own clock, not index over rate
  Image image;
};

}  // namespace marey
