// A ball that lies still looks like a bit of paint, until it is played or after it has come to rest: where a sure path begins, what
// lay there before and is gone afterwards was the ball; and where one ends, vice versa.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/track/ball/ball_smooth.h"

namespace marey::track::ball {

struct BallRestOptions {
  double reach = 2.5;       ///< m, between a path's end and where the ball lay: its first steps are often hidden
  double within = 2;        ///< px, of where it lies, that it is seen
  double inspect = 1.5;     ///< s before and after, in which it must have been seen,
  double detected = 0.6;    ///< in this share of instants on the one side,
  double gone = 0.15;       ///< and no more than this on the other
  double unobserved = 1.5;  ///< s unobserved, after which its position is unknown
};

/// Adds to `way`, where it begins and ends, the instants at which the ball lay still. `way` has one entry an instant.
void add_rests(std::span<const BallObservations> time_steps, const GroundViews& views, const BallRestOptions& options,
               std::vector<std::optional<BallState>>& method);

}  // namespace marey::track::ball
