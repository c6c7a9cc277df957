#pragma once

#include <span>
#include <string>
#include <vector>

#include "marey/core/detection.h"
#include "marey/core/foreground.h"
#include "marey/core/frame.h"

namespace marey::detect {

struct Detections {
  std::vector<Detection> detections;
  Foreground foreground;  ///< empty where the detector has no background model
};

/// Finds things in frames.
class Detector {
 public:
  virtual ~Detector() = default;

  /// Frames sampled from the recording ahead, before the first `detect`: a file is read ahead, a live camera is not.
  virtual void prime(std::span<const Frame> /*samples*/) {}

  /// What is seen in `frame`. Frames come in order. `expected` says where the tracker expects its targets: a person who stands
  /// still there is not learned as background, and a region several share is split among them.
  virtual Detections detect(const Frame& frame, std::span<const Expected> expected) = 0;

  /// What a user should know of what was seen so far, one sentence each.
  virtual std::vector<std::string> warnings() const { return {}; }
};

}  // namespace marey::detect
