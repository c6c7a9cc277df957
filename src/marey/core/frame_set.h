#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "marey/core/detection.h"
#include "marey/core/frame.h"

namespace marey {

/// What one camera gave to one instant.
struct CameraFrame {
  Frame frame;  ///< its time is by the run's clock; its image is empty if detections come from another program
  /// The detections in it, where the camera's feed knows that already: another program said so, or the feed searches for it itself.
  std::optional<std::vector<Detection>> detections;
  double decode_s = 0, detect_s = 0;  ///< what it took, s
};

/// How a camera is.
enum class FeedState {
  connecting,  ///< nothing has come yet
  live,        ///< it gives frames
  stalled,     ///< nothing came for a while
  lost,        ///< nothing came for so long that it is no longer waited for
  back,        ///< it gives frames again after it was stalled or lost, since a short while
  ended,       ///< nothing will come any more
};

/// "connecting", "live", …
constexpr std::string_view to_string(FeedState state) {
  constexpr std::string_view kNames[] = {"connecting", "live", "stalled", "lost", "back", "ended"};
  return kNames[static_cast<std::size_t>(state)];
}

/// What all cameras of a rig gave to one instant. A camera that had nothing is a gap.
struct FrameSet {
  std::int64_t index = 0;                           ///< counts the instants
  Timestamp time{};                                 ///< by the run's clock
  std::vector<std::optional<CameraFrame>> cameras;  ///< CameraId i is cameras[i]
  std::vector<FeedState> states;                    ///< of each camera

  bool complete() const {
    for (const auto& camera : cameras) {
      if (!camera) return false;
    }
    return true;
  }
};

}  // namespace marey
