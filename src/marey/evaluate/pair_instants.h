#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/ground_recording.h"
#include "marey/evaluate/ground_evaluation.h"

namespace marey::evaluate {

/// The instants of a recording, which are its different frames, and how they follow each other.
struct InstantClock {
  struct Instant {
    std::int32_t frame = 0;
    double time = 0;  ///< s
  };
  std::vector<Instant> instants;  ///< by frame
  std::optional<double> period;   ///< s, the median between two instants; nothing where there are fewer than two
  std::optional<double> frame_s;  ///< s a frame number, likewise
};

InstantClock clock_of(const GroundRecording& recording);

/// The common number of each frame of a recording; frames that are not judged are in none.
using CommonNumbers = std::map<std::int32_t, std::int32_t>;

/// Which instants of two recordings are the same.
struct InstantPairing {
  CommonNumbers truth, tracks;
  bool by_time = false;               ///< instants were paired by time, not by frame number
  std::vector<std::string> warnings;  ///< one sentence each
};

/// Instants go together by frame number where frames mean the same time in both, else by time, the nearest within half a period;
/// where one recording has instants more often, the other's instants alone are judged.
InstantPairing pair_instants(const InstantClock& truth, const InstantClock& tracks);

/// The places of a recording under the common numbers, by number.
std::vector<PersonPlace> places_of(const GroundRecording& recording, const CommonNumbers& numbers);

}  // namespace marey::evaluate
