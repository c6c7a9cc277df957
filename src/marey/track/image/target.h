#pragma once

#include <optional>

#include "marey/core/ids.h"
#include "marey/core/observation.h"
#include "marey/core/time.h"
#include "marey/filter/any_filter.h"
#include "marey/track/evidence.h"
#include "marey/track/image/box_noise.h"
#include "marey/track/image/box_size.h"
#include "marey/track/image/unoccluded_motion.h"

namespace marey::track::image {

inline bool has_extent(const Observation<2>& observation) {
  return observation.box && !observation.box->empty();
}

/// Of its box where there is one.
inline Vector<2> centre_of(const Observation<2>& observation) {
  return observation.box ? observation.box->centre() : observation.value;
}

/// One target in the image: its motion, its size, and the evidence that it is there.
struct Target {
  TrackId id;
  filter::AnyFilter<2> filter;
  std::optional<BoxSize> size;
  double unit = 1;  ///< length of one size in the observations' unit: its height in the image, or 1
  Timestamp initiated;
  Timestamp last_observed;
  Evidence evidence;
  double score = 1;                     ///< of the last observation
  std::optional<int> observation = {};  ///< index of this frame's
  bool crowded = false;                 ///< its box meets another target's
  bool hidden = false;                  ///< not seen, and another target or a shared region explains why
  UnoccludedMotion unoccluded_motion = {};
  std::optional<Box> shown = {};  ///< its output in this frame, where that is not `size` about the filter's place
  BoxTrail trail = {};            ///< where the boxes' noise is learned

  bool confirmed() const { return evidence.confirmed(); }
};

}  // namespace marey::track::image
