#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/camera_health.h"
#include "marey/core/frame.h"
#include "marey/core/frame_set.h"

namespace marey {

/// The properties of a source before its first frame.
struct SourceInfo {
  std::string name;                         ///< as the user would recognise it: the path given
  cv::Size size;                            ///< px
  std::optional<double> rate_hz;            ///< what the header says, or what the user said instead
  std::optional<std::int64_t> frame_count;  ///< an estimate, for progress only
};

/// Where frames come from: video files, folders of images, cameras, the simulator.
class Source {
 public:
  virtual ~Source() = default;

  virtual const SourceInfo& info() const = 0;

  /// The next frame, in order, its time later than the last one's; nothing at the end. Never throws for a file that breaks
  /// off or a frame that cannot be decoded: the loss is reported by `warnings`.
  virtual std::optional<Frame> next() = 0;

  /// What went wrong so far without stopping the source, one sentence each: where a file breaks off, what was omitted.
  virtual std::vector<std::string> warnings() const { return {}; }
};

/// A camera that does not wait for its reader.
class LiveSource {
 public:
  virtual ~LiveSource() = default;

  /// Size and rate are known once it was connected, not before.
  virtual SourceInfo info() const = 0;

  /// What has come since the last call, of that the last few, in order; their times are by the run's clock. Never waits.
  virtual std::vector<CameraFrame> arrived() = 0;
  /// Whether it is there now. One that is not is searched for again, without end.
  virtual bool connected() const { return true; }
  /// Images of another size are not taken from now on.
  virtual void take_only(cv::Size /*size*/) {}
  /// Whether nothing will come any more.
  virtual bool ended() const = 0;
  /// Its counts of frames so far; its name and how long it has been silent are for its reader to know.
  virtual CameraHealth health() const { return {}; }
  virtual std::vector<std::string> warnings() const { return {}; }
};

}  // namespace marey
