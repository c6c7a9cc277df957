#pragma once

#include "marey/core/instant.h"
#include "marey/core/recording.h"

namespace marey {

/// Where the results of a run go: a file, a video, a plot, a stream, a callback. Called in this order, from one thread at a time:
/// `begin` once, `write` for each instant by growing index, `finish` once. A sink that is destroyed without `finish` leaves nothing
/// behind (a take: the output until then).
class Sink {
 public:
  /// What a sink must be given beside the samples.
  struct SinkRequirements {
    bool images = false;    ///< `Instant::frames`
    bool boxes = false;     ///< `Instant::boxes`
    bool detected = false;  ///< `Instant::seen`
  };

  virtual ~Sink() = default;

  /// What it is, for messages: "tracks.csv".
  virtual std::string name() const = 0;

  /// Throws Error if such a recording cannot be written, or the place is not there.
  virtual SinkRequirements begin(const RecordingHeader& header) = 0;
  /// Throws Error if the place is full; the sink then takes no more.
  virtual void write(const Instant& instant) = 0;
  /// Commits the output.
  virtual void finish() = 0;
};

}  // namespace marey
