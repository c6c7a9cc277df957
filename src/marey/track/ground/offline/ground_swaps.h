// The assignment of two people after they have met.
//
// Where two people come so near to each other that a camera cannot well distinguish them, a tracker has to guess who is who, from
// what came before. Here what comes after is known too: both ways of continuing, straight and exchanged, are evaluated by how well
// each one's place and velocity before fits place and velocity after, and by what they wear. Where exchanging explains much more,
// the later parts are exchanged, at the instant at which the two were nearest. Meetings are settled in the order of time. Cost: the
// pairs of people of each instant, and two short filters for each meeting.
#pragma once

#include <span>
#include <vector>

#include "marey/core/time.h"
#include "marey/track/ground/offline/encounters.h"
#include "marey/track/ground/offline/ground_tracklet.h"

namespace marey::track::ground::offline {

struct SwapRepairOptions : CloseEncounterOptions {
  std::optional<GroundTeams> teams = {};
  double certainly = 6;  ///< logarithm of how much likelier exchanging must be
};

/// `tracklets` of which some are exchanged from some sample on. `times` by instant. Returns how many meetings were exchanged.
int repair_swaps(std::vector<GroundTracklet>& tracklets, std::span<const Timestamp> times, const SwapRepairOptions& options = {});

}  // namespace marey::track::ground::offline
