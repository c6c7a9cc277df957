// Where two people came so near to each other that they may have been taken for one another, and how well paths before and after
// fit each other, straight and exchanged. Cost: the pairs of people of each instant, and four short filters for each meeting.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/time.h"
#include "marey/track/ground/offline/ground_join.h"
#include "marey/track/ground/offline/ground_tracklet.h"

namespace marey::track::ground::offline {

struct CloseEncounterOptions {
  double near = 1.2;        ///< m, besides what is uncertain of the places: people nearer than this meet
  double evaluated_by = 3;  ///< s before and after
  double max_speed = 12;    ///< m/s
  GroundMotion motion;
};

/// Two who were near each other.
struct CloseEncounter {
  int a = 0, b = 0;                                           ///< tracklets, a < b
  std::int32_t first = 0, last = 0, nearest = 0;              ///< instants
  double distance = std::numeric_limits<double>::infinity();  ///< at the nearest, m²
};

/// All meetings, in the order in which the two were nearest. `times` by instant.
std::vector<CloseEncounter> find_encounters(std::span<const GroundTracklet> tracklets, std::span<const Timestamp> times,
                                            double near);

/// Logarithm of how much likelier it is, by place, velocity and clothes before and after, that the two were exchanged in the
/// meeting than that they were not. Nothing if either was seen too briefly to decide, or would have had to be too fast.
std::optional<double> gain_of_swap(std::span<const GroundSample> a, std::span<const GroundSample> b,
                                   const CloseEncounter& close_encounter, std::span<const Timestamp> times,
                                   const GroundColours& colours, const CloseEncounterOptions& options);

}  // namespace marey::track::ground::offline
