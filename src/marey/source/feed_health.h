#pragma once

#include <optional>

#include "marey/core/frame_set.h"
#include "marey/core/time.h"
#include "marey/source/live_time.h"

namespace marey::source {

/// How a live camera is, by when its frames came.
class FeedHealth {
 public:
  void observed_frame(Timestamp now, const LivePolicy& policy) {
    if (last_ && seconds(now - *last_) >= policy.stalled_s) back_since_ = now;
    last_ = now;
  }

  /// Where a camera never came it is connecting, and lost once it could have been lost since `begin`.
  FeedState at(Timestamp now, Timestamp begin, const LivePolicy& policy) const {
    const double silent_s = seconds(now - last_.value_or(begin));
    if (silent_s >= policy.lost_s) return FeedState::lost;
    if (!last_) return FeedState::connecting;
    if (silent_s >= policy.stalled_s) return FeedState::stalled;
    return back_since_ && seconds(now - *back_since_) < policy.stalled_s ? FeedState::back : FeedState::live;
  }

 private:
  std::optional<Timestamp> last_, back_since_;
};

}  // namespace marey::source
