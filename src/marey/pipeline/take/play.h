// A recording played as if it were captured now: each instant goes to the sinks when it is due. So clients of live streams are
// developed without cameras.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/core/recording_reader.h"
#include "marey/core/sink.h"
#include "marey/stream/stream_clock.h"

namespace marey::pipeline::take {

struct PlayOptions {
  std::string name = {};               ///< of the recording, where it does not specify one itself
  bool loop = false;                   ///< from the beginning again, until it is stopped; indices and times continue growing
  double speed = 1;                    ///< times as fast as it was recorded
  std::optional<double> rate_hz = {};  ///< at most this many instants a second of the recording; all where it is omitted
};

struct PlaySummary {
  std::int64_t instants = 0;  ///< given to the sinks
  std::int64_t excluded = 0;  ///< because of the rate
  std::int64_t skipped = 0;   ///< too late by more than `kTooLate`: this machine was too slow for them
  std::int64_t rounds = 0;    ///< times the recording was begun
  double seconds = 0;         ///< of wall time
  std::vector<std::string> warnings;
  bool stopped = false;
};

/// An instant that is so late is skipped where a later one is due too, so that a hiccup does not add up.
inline constexpr Duration kTooLate = std::chrono::milliseconds(200);

/// `open` opens the recording, once for each round. `clock`, where there is one, is reported when instants are captured. Sinks are
/// written on this thread; a sink that waits holds up the others. They are finished when the recording ends and when it is stopped.
/// Throws Error if the recording cannot be read or a sink fails.
PlaySummary play(const std::function<std::unique_ptr<RecordingReader>()>& open, const std::vector<std::unique_ptr<Sink>>& sinks,
                 const PlayOptions& options, stream::CaptureClock* clock = nullptr, const Hooks& hooks = {});

}  // namespace marey::pipeline::take
