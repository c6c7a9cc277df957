#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "marey/core/frame_set.h"

namespace marey {

/// How a camera is, and its counts of frames: the same for a live camera, a node, a run, its summary and the viewer.
struct CameraHealth {
  std::string name = {};
  FeedState state = FeedState::connecting;
  std::string trouble = {};            ///< what went wrong last, one sentence; empty if nothing did
  std::optional<double> rate_hz = {};  ///< of the frames that came lately, or as the camera states it
  std::int64_t connections = 0;        ///< how often it was opened
  std::int64_t frames = 0;             ///< that came
  std::int64_t missed = 0;             ///< instants without a frame of it
  std::int64_t lost = 0;               ///< frames that it captured and that never came, by the gaps in its own numbers
  std::int64_t damaged = 0;            ///< frames that came in part, could not be decoded, or had another size than the first
  std::int64_t overrun = 0;            ///< frames that came and were dropped because nothing had time for them
  std::int64_t detections = 0;         ///< in its last frame; in a summary: of all frames, that the tracker was given

  /// Frames that it captured and nothing was made of.
  std::int64_t dropped() const { return lost + damaged + overrun; }
  bool gives_frames() const { return state == FeedState::live || state == FeedState::back; }
};

}  // namespace marey
