#pragma once

#include <span>
#include <vector>

#include "marey/core/observation.h"
#include "marey/core/time.h"
#include "marey/core/track.h"

namespace marey {

/// Follows many targets: observations of one instant in, tracks out. D = 2 in the image (px) and on the ground (m), 3 in space.
template <int D>
class Tracker {
 public:
  virtual ~Tracker() = default;

  /// Takes in what was seen at `now`, later than the last call's, and reports every target that is followed.
  virtual std::vector<Track<D>> step(Timestamp now, std::span<const Observation<D>> seen) = 0;

  /// Where each target is expected at `now`, before it is looked at.
  virtual std::vector<Track<D>> expected(Timestamp now) const = 0;
};

}  // namespace marey
