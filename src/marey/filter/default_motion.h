#pragma once

// A filter for things of which it is known how they usually move: what it takes for likely before it has seen one of them move.
// The defaults of the named filters are a marker's, which may be on a foot: in body heights a second that is ten, and a person who
// has been seen once would be expected anywhere in the image.

#include "marey/filter/filters.h"

namespace marey::filter {

/// Lengths in the filter's unit.
struct DefaultMotion {
  double speed = 0;               ///< standard deviation per axis of the velocity of one that was seen once, 1/s
  double acceleration_noise = 0;  ///< white acceleration, square root of its density: 1/s^1.5
};

/// People, in heights of theirs: as TrackerOptions::filter has it (track/tracker.h), whose sweep is in bench/tuning.md.
inline constexpr DefaultMotion kPeopleInHeights{.speed = 0.8, .acceleration_noise = 0.45};
/// People and athletes on the ground, in m: as GroundTrackerOptions::filter has it (track/ground/ground_tracker.h).
inline constexpr DefaultMotion kPeopleInMetres{.speed = 3, .acceleration_noise = 2};

/// `options` for things that move like this. What a filter fixes whatever moves (gains, radii, rates of change) stays.
FilterOptions for_motion(const FilterOptions& options, const DefaultMotion& motion);

/// The filter called `name` for people in an image, lengths in heights of theirs. Throws Error as filter_named does.
FilterOptions filter_for_people_in_image(std::string_view name);
/// The same for people on the ground, in m.
FilterOptions filter_for_people_on_ground(std::string_view name);

}  // namespace marey::filter
