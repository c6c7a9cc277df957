// Times on wires. One clock on this host, the steady one, in which a client on the same host can compute how old a frame is; the
// time of day for those that want it.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "marey/core/time.h"

namespace marey::stream {

/// ns of CLOCK_MONOTONIC, which Python calls time.monotonic_ns().
std::int64_t steady_now_ns();
/// ns since 1970, UTC.
std::int64_t wall_now_ns();

/// A frame's, ns of the steady clock.
struct FrameTimes {
  std::int64_t capture = 0;  ///< cameras saw it; of a recording that is played, it is due
  std::int64_t solve = 0;    ///< it was known what they saw: the wire was given it
  std::int64_t send = 0;     ///< its bytes were made
};

/// When an instant was captured. The one who captures or plays sets it; where it is not set, the least delay that was seen counts
/// as none.
class CaptureClock {
 public:
  /// `time` is at `steady_ns`, and time goes `speed` times as fast.
  void set(Timestamp time, std::int64_t steady_ns, double speed = 1);
  /// Of an instant that arrived at `arrived`; never later than that.
  std::int64_t capture_ns(Timestamp time, std::int64_t arrived);

 private:
  std::atomic<std::int64_t> zero_ns_{0};  // the steady time of the recording's beginning
  std::atomic<double> speed_{1};
  std::atomic<bool> set_{false}, learned_{false};
};

}  // namespace marey::stream
