// What a kind of live camera must bring: how it is connected, and how it gives frames while it is. Everything that all kinds share
// (the thread, the endless retry, the clock, what is counted) is in live_camera.h.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "marey/core/frame_set.h"
#include "marey/core/source.h"
#include "marey/source/live/camera_controls.h"
#include "marey/source/live_time.h"

namespace marey::source::live {

/// A frame as its camera gave it. When it was taken is reported by `taken`, else by `device_time`, else it is when it came.
struct Shot {
  CameraFrame given;                          ///< its image or its detections; index and time are not used
  std::optional<Timestamp> taken = {};        ///< by the run's clock
  std::optional<Duration> device_time = {};   ///< by the camera's own clock, from any origin
  std::optional<std::int64_t> sequence = {};  ///< by the camera's own count: what it omits was lost in transit
};

enum class Came {
  frame,    ///< the shot is filled
  nothing,  ///< yet
  damaged,  ///< a frame that came in part, or could not be decoded
  end,      ///< of all frames, permanently: of a video that is played
};

/// A camera while it is connected.
class Connection {
 public:
  virtual ~Connection() = default;

  /// Valid until the next call of `next`; an empty size if only images will show it.
  virtual const SourceInfo& info() const = 0;
  /// Waits for the next frame, a tenth of a second at most (kStopSlice). Throws Error if the camera is gone.
  virtual Came next(Shot& shot) = 0;

  /// Whether its frames' numbers continue where those of the connection before ended: what was missed in between is counted as
  /// lost.
  virtual bool continues_numbers() const { return false; }

  /// What of it can be set while it gives images, and how it is now.
  virtual std::vector<ControlRange> controls() { return {}; }
  /// Called between two calls of `next`. Throws Error if the camera refuses.
  virtual void set(Control control, double value);
};

/// Connects the camera, or throws Error if it is not there. It may take a few seconds, and ends early where `stop` says so.
using Connect = std::function<std::unique_ptr<Connection>(LiveTime& time, const std::stop_token& stop)>;

}  // namespace marey::source::live
