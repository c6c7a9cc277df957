// A camera's keypoints out of a recording of its image.
#pragma once

#include <string>

#include "marey/core/keypoint_sequence.h"
#include "marey/core/recording_reader.h"
#include "marey/core/sink.h"

namespace marey::pipeline::keypoints {

/// Gathers the keypoints of everything that is written to it. A recording's instants are the frames of the sequence: one that is
/// omitted has no person in it. `into.from` names the source for messages; `into` must outlive the sink.
class KeypointCollector final : public Sink {
 public:
  explicit KeypointCollector(KeypointSequence& into) : into_(into) {}

  std::string name() const override { return into_.from; }
  /// Throws Error if the recording's positions are not px of an image, or if it has no keypoints.
  SinkRequirements begin(const RecordingHeader& header) override;
  void write(const Instant& instant) override;
  void finish() override {}

 private:
  KeypointSequence& into_;
};

/// Reads a take of `marey track --targets keypoints`. Throws Error likewise, and if it cannot be read.
KeypointSequence keypoints_of_take(const std::string& path);

}  // namespace marey::pipeline::keypoints
