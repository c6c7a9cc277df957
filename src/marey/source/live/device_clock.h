// When a frame was taken, from when its camera says that it was and from when it came.
//
// A camera's clock has another origin than the host's and drifts by up to some hundred parts in a million; what comes over a wire
// or a bus comes late, by a little or by a lot, and never early. So arrival − device time is a straight line plus a delay that is
// never negative, and the line is the lower envelope: of all lines that no arrival lies below, the one with the least sum of
// distances. That is the edge of the lower convex hull over the mean of the device times, exactly (a linear programme in two
// unknowns). The window slides, each half second is kept by its least delayed frame: 60 points, a few µs a frame.
//
// What cannot be known is the least delay itself: all cameras of one kind have the same.
// A device's clock that is set (backwards, or ahead of what any delay allows) begins a new fit.
// Reference: Zhang, Liu, Xia, "Clock synchronization algorithms for network measurements", INFOCOM 2002 (convex hulls).
#pragma once

#include <deque>
#include <optional>

#include "marey/core/time.h"

namespace marey::source::live {

struct DeviceClockOptions {
  double window_s = 30;     ///< that the line is fitted over
  double bucket_s = 0.5;    ///< of which one frame is kept
  double settle_s = 4;      ///< before this much has been seen no drift is taken from it: noise of 0.1 ms would be 25 ppm
  double max_drift = 5e-4;  ///< no quartz is worse
  double step_s = 0.05;     ///< a device's clock that is so far ahead of the fit was set
};

class DeviceClock {
 public:
  explicit DeviceClock(const DeviceClockOptions& options = {}) : options_(options) {}

  /// By the run's clock, never later than `arrival`. Frames come in order of arrival.
  Timestamp time_of(Duration device, Timestamp arrival);
  /// How much faster than the device's the host's clock goes: 50e-6 is 50 ppm.
  double drift() const { return slope_; }
  /// How often the device's clock was set.
  int steps() const { return steps_; }
  void reset();

 private:
  struct Point {
    double device = 0, ahead = 0;  // s from the origins; arrival − device
  };
  void keep(const Point& point);
  void fit();
  double ahead_at(double device) const { return offset_ + slope_ * device; }

  DeviceClockOptions options_;
  std::optional<Duration> device_origin_;
  Timestamp arrival_origin_{};
  std::deque<Point> kept_;  // by device time; the last one's bucket is open
  double last_ = 0, offset_ = 0, slope_ = 0;
  int steps_ = 0;
};

}  // namespace marey::source::live
