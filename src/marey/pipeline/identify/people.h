// A take of people on the ground as what identities are decided on: tracks cut where a person was lost, and who was named.
#pragma once

#include <span>
#include <vector>

#include "marey/core/recording.h"
#include "marey/format/match/squads.h"
#include "marey/track/ground/offline/ground_identities.h"

namespace marey::pipeline::identify {

using format::match::SquadMember;
using format::match::SquadNaming;

struct TrackedPeople {
  std::vector<track::ground::offline::GroundTracklet>
      tracklets;                 ///< by track, then by time; each begins its first run with its track
  std::vector<int> teams;        ///< of each: 0, 1, or −1 where the take does not specify
  std::vector<Timestamp> times;  ///< by instant
};

/// Throws Error if no person was measured.
TrackedPeople tracked_people(const Recording& recording);

/// Throws Error, with the row, for a track that is not there at that time (with those that were, the nearest first), one member in
/// two places at once, two members in one, or a member who was not on the pitch by then.
std::vector<track::ground::offline::IdentityAnnotation> namings_of(std::span<const SquadNaming> given,
                                                                   const std::vector<SquadMember>& squads,
                                                                   const Recording& recording, const TrackedPeople& people);

}  // namespace marey::pipeline::identify
