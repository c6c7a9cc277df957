// The time of live runs. Only when a camera counts as late depends on it: what is made of its frames goes by the frames' own times.
#pragma once

#include <memory>

#include "marey/core/time.h"

namespace marey::source {

/// What time it is by the run's clock, and waiting for it to continue. Tests have one of their own.
class LiveTime {
 public:
  virtual ~LiveTime() = default;
  virtual Timestamp now() = 0;
  /// For a short while, a few milliseconds at most, or until `wake`.
  virtual void wait() = 0;
  /// A frame has come: a waiting caller need not wait longer. From any thread.
  virtual void wake() {}
};

/// Counts from now on.
std::shared_ptr<LiveTime> steady_time();

/// When a live camera counts as what.
struct LivePolicy {
  std::shared_ptr<LiveTime> time;  ///< never null
  double late_s = 0.1;             ///< an instant waits this long for its frames, then it continues without
  double stalled_s = 1;            ///< a camera that gave nothing for this long is stalled: nothing waits for it
  double lost_s = 5;               ///< likewise lost
};

}  // namespace marey::source
