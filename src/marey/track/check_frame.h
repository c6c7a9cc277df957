#pragma once

#include <cmath>
#include <optional>
#include <span>

#include "marey/core/error.h"
#include "marey/core/observation.h"
#include "marey/core/time.h"

namespace marey::track {

/// Throws Error if a frame does not come after the one `before` it.
inline void check_time(Timestamp now, std::optional<Timestamp> before) {
  if (before && now <= *before) {
    throw Error("the frame at {:.6f} s does not come after the one at {:.6f} s; the times of frames must grow", seconds(now),
                seconds(*before));
  }
}

/// Throws Error if an observation contains a value that is not finite, or has no covariance.
template <int D>
void check_finite(Timestamp now, std::span<const Observation<D>> detected) {
  for (const Observation<D>& observation : detected) {
    const bool box_is_finite =
        !observation.box || (std::isfinite(observation.box->left) && std::isfinite(observation.box->top) &&
                             std::isfinite(observation.box->width) && std::isfinite(observation.box->height));
    if (!observation.covariance) throw Error("an observation at {:.6f} s has no covariance; a tracker needs one", seconds(now));
    if (!observation.value.allFinite() || !observation.covariance->allFinite() || !std::isfinite(observation.score) ||
        !box_is_finite)
      throw Error("an observation at {:.6f} s is not a finite number; leave it out", seconds(now));
  }
}

}  // namespace marey::track
