// Markers that are hidden for a while: between which frames a segment is seen in part only, and where its other markers sit
// in the meantime.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/skeleton.h"
#include "marey/solve/skeleton/calibrate.h"

namespace marey::solve::skeleton {

/// For one frame: the nearest frames at or before and at or after it in which a segment's markers were all seen that are seen
/// around it at all.
struct WholeFrames {
  std::optional<std::size_t> before, after;
};

/// By segment and frame. A segment's markers are its own, its parent's and its children's; one that is away for longer than
/// `hidden` frames, or since the beginning, is not missed.
std::vector<std::vector<WholeFrames>> whole_frames(const Skeleton& skeleton, std::span<const ObservedMarkers> frames,
                                                   std::size_t hidden);

/// How much of what held before and after counts at `frame`: both fade with the distance, within `hidden` frames at the latest.
struct Fractions {
  double before = 0, after = 0;
};
Fractions fractions_of(const WholeFrames& whole, std::size_t frame, std::size_t hidden);

}  // namespace marey::solve::skeleton
