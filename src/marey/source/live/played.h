#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "marey/core/source.h"
#include "marey/source/live/connection.h"

namespace marey::source::live {

/// Gives a source's frames when their times have come, as if they were taken now; `begin` is when its time is 0. Frames that
/// were not taken in time (their decoding takes too long) are omitted, and count as lost.
struct PlayOptions {
  std::function<Timestamp()> begin;  ///< asked once, when it is connected; several cameras' is one
  bool loop = false;                 ///< from the beginning again, without end
};

Connect play(std::function<std::unique_ptr<Source>()> open, const PlayOptions& options);

/// Periods: what comes later than its time by more is omitted.
inline constexpr double kMaxBehind = 2;

/// Waits until `due` or for kStopSlice, whichever is sooner; whether it is due.
bool wait_until_due(Timestamp due, LiveTime& time, const std::stop_token& stop);

}  // namespace marey::source::live
