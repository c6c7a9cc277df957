#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/recording.h"

namespace marey::evaluate {

/// How the instants of a recording follow each other. The recording must outlive it.
struct InstantClock {
  const std::vector<Recording::TimeStep>& instants;
  double period = 0;   ///< s, the median between two instants; 0 where there are fewer than two
  double frame_s = 0;  ///< s a frame number, likewise

  double time(std::size_t i) const { return seconds(instants[i].time); }
};

InstantClock clock_of(const Recording& recording);

/// The common number of each instant of a recording; those that are not evaluated have none.
using CommonNumbers = std::vector<std::optional<std::int32_t>>;

/// Which instants of two recordings are the same.
struct InstantPairing {
  CommonNumbers truth, tracks;
  bool by_time = false;               ///< instants were paired by time, not by frame number
  std::vector<std::string> warnings;  ///< one sentence each
};

/// Instants go together by frame number where frames mean the same time in both, else by time, the nearest within half a period;
/// where one recording has instants more often, the other's instants alone are evaluated.
InstantPairing pair_instants(const InstantClock& truth, const InstantClock& tracks);

}  // namespace marey::evaluate
