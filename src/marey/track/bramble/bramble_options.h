#pragma once

#include <cstdint>

namespace marey::track::bramble {

/// What the paper says of these is not at hand (bramble_tracker.h): all are ours.
struct BrambleOptions {
  int particles = 1000;
  bool partitioned = true;  ///< people are sampled one after the other; else all at once
  std::uint64_t seed = 1;
};

}  // namespace marey::track::bramble
