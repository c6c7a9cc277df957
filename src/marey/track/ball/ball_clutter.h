// How much a thing seen weighs as the ball: little where false things are seen often. Shirts, socks and limbs are seen on people
// and close to them, bits of paint at one place again and again.
#pragma once

#include <span>

#include "marey/core/ground_views.h"
#include "marey/track/ball/ball_observations.h"

namespace marey::track::ball {

struct BallClutterOptions {
  double min_open = 1;       ///< false things in an image away from people, on average, at least
  double max_clutter = 0.1;  ///< what has more is a part of a person
  double recurs_for = 2;     ///< s before and after, in which a thing that is seen at the same place again
  double recurs_from = 0.4;  ///< and no sooner than that, so that a ball which rolls slowly is not one
  double recurs_within = 4;  ///< px
};

/// Sets `false_density` and `on_person` of everything seen, by what all the instants show. Densities are those of four zones, on
/// people, close to them, beyond the lines (pixels whose rays meet the ground outside `pitch`, or not at all: stands) and
/// elsewhere, each counted over all instants, and of observations at that place. The ball is counted too, which makes little
/// of a difference where it moves. Boxes of people may overlap: their areas are added up.
void weigh_sightings(std::span<BallObservations> time_steps, const GroundViews& views, const BallClutterOptions& options,
                     const GroundRegion& pitch = {});

/// Where a person's limbs may be seen, px: a little more than the box.
Box limbs_of(const Box& person);

}  // namespace marey::track::ball
