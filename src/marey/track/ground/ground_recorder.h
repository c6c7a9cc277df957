#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/ground_recording.h"
#include "marey/core/time.h"
#include "marey/core/track.h"

namespace marey {

/// Lengths in m, times in s.
struct GroundJoinOptions {
  double longest_gap = 20;    ///< who reappears later is somebody new
  double longest_filled = 5;  ///< a longer gap is joined, but nothing is said of where the person was meanwhile
  double shortest = 0.5;      ///< who is seen for less is taken for a false alarm
  double max_speed = 12;      ///< m/s; nobody runs faster
  double smoothing = 0.3;     ///< standard deviation of the kernel that smooths places
};

/// What a ground tracker said, instant by instant, kept for a second pass that may look ahead: at most 48 bytes a person and
/// instant. Targets that are never confirmed are forgotten as they end.
class GroundRecorder {
 public:
  /// The tracks of one instant, as GroundTracker::step gave them. Frames come in order, each once.
  void add(std::int32_t frame, Timestamp time, std::span<const Track<2>> tracks);

  /// Joins what is one person's (by place, speed and what they wear), drops false alarms, fills gaps, smooths. Ids are given anew
  /// from 1 in the order of first appearance; `first_ids` of a person are the tracks' ids that it was made of. Used up afterwards.
  struct Joined {
    GroundRecording recording;                     ///< world's ground, m; teams empty
    std::vector<std::vector<TrackId>> first_ids;   ///< of each person
    std::vector<std::optional<Appearance>> wears;  ///< of each person: the median over all that was seen of it
  };
  Joined join(const GroundJoinOptions& options = {}) &&;
};

}  // namespace marey
