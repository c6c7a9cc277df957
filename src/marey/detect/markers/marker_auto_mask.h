#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <opencv2/core.hpp>

#include "marey/core/time.h"
#include "marey/detect/markers/marker_runs.h"

namespace marey::detect::markers {

/// Learns from the first seconds what stands out and does not move: lamps, reflections. A pixel that passed the threshold in nine
/// of ten frames is omitted from then on, with 2 px around it. A marker that stands still all the while is omitted with it.
class MarkerAutoMask {
 public:
  explicit MarkerAutoMask(double seconds) : length_(duration_from_seconds(seconds)) {}

  bool learning() const { return !finished_; }

  /// Takes in one frame's runs. Returns the mask with the first frame after the time is over, once.
  std::optional<MarkerMask> add(Timestamp time, cv::Size size, std::span<const MarkerRun> runs);

  /// Ends at once; the mask of the observations so far.
  MarkerMask finish();

 private:
  Duration length_;
  std::optional<Timestamp> begin_;
  cv::Mat passed_;  // CV_32SC1, frames
  int frames_ = 0;
  bool finished_ = false;
};

}  // namespace marey::detect::markers
