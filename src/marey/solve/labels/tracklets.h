// Pieces of tracks that are one marker's for certain, and chains of pieces that are most likely one marker's.
//
// A track is cut where it has a gap, and where it jumps: where it is neither where the motion before nor where the motion after
// says. That is where trackers exchange markers. A piece is then tied to the one that continues where it is due, if no other end
// and no other beginning comes into question: so what was exchanged is corrected before names are searched for.
#pragma once

#include <cstdint>
#include <vector>

#include "marey/core/ids.h"
#include "marey/core/recording.h"

namespace marey::solve::labels {

/// A segment of one track without a gap: rows `first_row` to `last_row`, instants `first` to `last`.
struct Tracklet {
  TrackId track{};
  std::size_t first_row = 0, last_row = 0;
  std::int32_t first = 0, last = 0;
  std::vector<Vector<3>> locations;  ///< m, by instant from `first` on
  bool after_jump = false;           ///< it was cut off from what comes before, because it jumps

  std::int32_t length() const { return last - first + 1; }
};

struct TrackletOptions {
  double jump = 0.010;         ///< m: less is not a jump
  double acceleration = 200;   ///< m/s²: more is a jump
  double longest_tied = 0.12;  ///< s: gaps that are bridged by motion alone
};

/// By first instant, then by track.
std::vector<Tracklet> tracklets_of(const Recording& recording, const TrackletOptions& options = {});

/// By tracklet, the number of its chain; chains are numbered by their first tracklets.
std::vector<int> chains_of(const std::vector<Tracklet>& tracklets, double rate_hz, const TrackletOptions& options = {});

}  // namespace marey::solve::labels
