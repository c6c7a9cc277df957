// A sink of what a background model says of frames, in place of tracks: it is written while the cameras' frames pass, and again
// for frames that are searched a second time.
#pragma once

#include <cstdint>

#include "marey/core/foreground.h"
#include "marey/core/sink.h"

namespace marey::pipeline::corridor {

/// The foreground of one frame.
struct FrameForeground {
  CameraId camera{};
  std::int64_t frame = 0;  ///< the camera's own count
  cv::Size size;           ///< px, of the frame
  Foreground foreground;
};

class ForegroundSink : public Sink {
 public:
  SinkRequirements begin(const RecordingHeader& /*header*/) override { return {}; }
  /// Instants are not for it.
  void write(const Instant& /*instant*/) final {}
  /// Throws Error if it cannot be written; the sink then takes no more. A frame may come twice: the later one counts.
  virtual void write_foreground(const FrameForeground& given) = 0;
};

}  // namespace marey::pipeline::corridor
