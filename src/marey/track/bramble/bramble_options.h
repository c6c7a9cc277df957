#pragma once

#include <cstdint>

namespace marey::track::bramble {

/// Lengths in m, times in s. What of these is the paper's is not at hand (bramble_tracker.h): all are ours.
struct BrambleOptions {
  int particles = 1000;
  bool partitioned = true;  ///< people are sampled one after the other (MacCormick, Isard 2000); else all at once, as published
  /// What neighbouring points of the grid tell is not independent: of their sum this share counts.
  double independence = 0.2;
  double arrivals = 1e-3;    ///< people a m² and second
  double departures = 0.02;  ///< a person and second, in view; out of every camera's view `lost`
  double lost = 1;
  double acceleration = 2.5;  ///< of people, m/s^1.5
  double least_share = 0.5;   ///< of the particles, that must hold a person who is told of
  double settles = 0.2;       ///< for so long a person must be held before being told of
  std::uint64_t seed = 1;
};

}  // namespace marey::track::bramble
