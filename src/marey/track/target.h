#pragma once

#include <optional>

#include "marey/core/ids.h"
#include "marey/core/time.h"
#include "marey/track/box_size.h"
#include "marey/track/unoccluded_motion.h"

namespace marey::track {

/// One thing that is followed: its motion, its size, and the evidence that it is there.
template <typename F>
struct Target {
  TrackId id;
  F filter;
  std::optional<BoxSize> size;
  double unit = 1;  ///< length of one size in the observations' unit: its height in the image, or 1
  Timestamp born;
  Timestamp last_seen;
  double evidence = 0;  ///< grows with each observation, shrinks with each miss; until it is confirmed
  bool confirmed = false;
  double score = 1;      ///< of the last observation
  int observation = -1;  ///< its index in this frame; -1 for none
  bool crowded = false;  ///< its box meets another target's
  bool hidden = false;   ///< not seen, and another target or a shared region explains why
  UnoccludedMotion<F::dimension> cruise{};
};

}  // namespace marey::track
