#pragma once

#include <string>

#include "marey/core/recording.h"
#include "marey/core/sink.h"

namespace marey {

/// Keeps what a run yields in memory.
class RecordingSink final : public Sink {
 public:
  /// `recording` must outlive the sink; it is begun again.
  explicit RecordingSink(Recording& recording) : recording_(recording) {}

  std::string name() const override { return "a recording in memory"; }
  SinkRequirements begin(const RecordingHeader& header) override {
    recording_ = Recording(header);
    return {.detected = true};
  }
  void write(const Instant& instant) override { recording_.add(instant); }
  void finish() override {}

 private:
  Recording& recording_;
};

}  // namespace marey
