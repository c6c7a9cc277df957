#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/detection.h"
#include "marey/core/foreground.h"
#include "marey/core/frame.h"
#include "marey/core/geometry.h"

namespace marey::detect {

struct Detections {
  std::vector<Detection> detections;
  Foreground foreground;  ///< empty if the detector has no background model
  bool searched = true;   ///< false: a frame that the detector skipped; nothing follows from it
};

/// What a detector's results mean: a value, so that our own silhouettes, a network's boxes and another program's stand side by
/// side.
struct DetectorTraits {
  double toe_m = 0;              ///< a box ends this far before the middle of the feet, on the ground, seen along the view
  bool has_foreground = false;   ///< whether `Detections::foreground` is filled
  bool knows_body_size = false;  ///< whether `body_at` answers, if not from the first frame on
};

/// Observations that were not reported, or are uncertain, since the beginning; nothing if a detector does not count it.
struct DetectionCounts {
  std::optional<std::int64_t> noise;    ///< regions too small to be what is searched for, or a part of it
  std::optional<std::int64_t> misfits;  ///< regions that what is searched for does not explain
};

/// Finds things in frames.
class Detector {
 public:
  virtual ~Detector() = default;

  /// Frames sampled from the recording ahead, before the first `detect`: a file is read ahead, a live camera is not.
  virtual void prime(std::span<const Frame> /*samples*/) {}

  /// The detections in `frame`. Frames come in order. `expected` says where the tracker expects its targets: a person who stands
  /// still there is not learned as background, and a region several share is split among them.
  virtual Detections detect(const Frame& frame, std::span<const Expected> expected) = 0;

  /// What a user should know of the observations so far, one sentence each.
  virtual std::vector<std::string> warnings() const { return {}; }

  /// The same for its whole life.
  virtual DetectorTraits traits() const { return {}; }

  /// For the summary of a run.
  virtual DetectionCounts detection_counts() const { return {}; }

  /// The empty scene as a background model has it; empty if no model has one.
  virtual Image scene() const { return {}; }

  /// The image shows the scene where `mask` (CV_8UC1, its upper left pixel at `corner`) is not 0: what was taken for it has gone.
  virtual void trust(const Image& /*image*/, const cv::Mat& /*mask*/, cv::Point /*corner*/) {}

  /// The box, px, of a person whose feet are at this pixel; nothing if that is not known.
  virtual std::optional<Box> body_at(const Vector<2>& /*foot*/) const { return std::nullopt; }
};

}  // namespace marey::detect
