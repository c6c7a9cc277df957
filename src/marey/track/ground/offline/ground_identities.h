// Who is who over a whole recording, once people were named: which paths the names go along.
//
// A tracker's tracks are cut wherever it may have been wrong: where two met (encounters.h) and where one was lost. Each
// segment between is one person's. How segments follow each other is then decided over the recording at once, so that the sum of
// logarithms of likelihoods is the greatest that is found:
//   meetings   two continue as they were tracked, or exchanged: by place, velocity and clothes right before and after;
//   gaps       an end is followed by a beginning, or none (ground_join.h);
//   roles      all segments of a path have their places among the others as one person has (ground_roles.h): minutes after two
//              were exchanged, the back is found where the winger was. This settles what the moment itself leaves open;
//   names      no person is two people: a path that was given two names is cut between them.
// From what the tracker thought, the search continues by the best of all moves that exchange what two paths have from some point
// on, or between two points, until none gains: Markov-chain data association's moves (Oh, Russell & Sastry, "Markov chain Monte
// Carlo data association for multi-target tracking", IEEE Trans. AC 54, 2009), taken greedily. How much the second-best move would
// lose is how sure each decision is. Assumes that most meetings are tracked rightly, and that roles last. Cost: for each move made
// the meetings and pairs of ends and beginnings, each in constant time, as sums along paths are kept.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "marey/core/time.h"
#include "marey/track/ground/offline/encounters.h"
#include "marey/track/ground/offline/ground_join.h"
#include "marey/track/ground/offline/ground_tracklet.h"

namespace marey::track::ground::offline {

/// A person was named.
struct IdentityAnnotation {
  int tracklet = 0;
  std::int32_t instant = 0;
  int name = 0;  ///< in [0, 256)
};

struct GroundIdentityOptions {
  CloseEncounterOptions close_encounter{.near = 2, .motion = {}};
  GroundChainOptions join;
  double swapped = -3;   ///< logarithm of the odds that a meeting was tracked exchanged, before anything else is known
  double trusted = 0.3;  ///< trusted share of the evidence of place and velocity about a meeting: tracks were smoothed through it
  double coming = 1e-6;  ///< people who come into a match, per m² and s
};

struct GroundIdentities {
  /// A part of a tracklet that is one person's. Without samples where two meetings are at one instant.
  struct TimeChunk {
    int tracklet = 0;
    std::int32_t first = 0, last = 0;  ///< instants, both included
    int path = 0;
  };
  /// One person's segments, in the order of time.
  struct Path {
    int name = -1;  ///< −1: not named by the user
    std::vector<int> segments;
  };
  /// Two met. `probability`: that `paths` should have been exchanged from there on.
  struct CloseEncounter {
    std::int32_t instant = 0;
    int before_a = 0, before_b = 0;  ///< segments
    bool swapped = false;            ///< against how they were tracked
    double probability = 0;
  };
  /// `after` was taken for the one of `before`. `probability`: that it is another person.
  struct Link {
    int before = 0, after = 0;  ///< segments
    double probability = 0;
  };
  /// Who an unnamed path may be; the rest of the probability is another person's.
  struct Candidate {
    int path = 0, name = 0;
    double probability = 0;
  };

  std::vector<TimeChunk> segments;  ///< by tracklet, then by time
  std::vector<Path> paths;
  std::vector<CloseEncounter> close_encounters;  ///< in the order of time
  std::vector<Link> links;                       ///< by `before`
  std::vector<Candidate> candidates;             ///< by path, the likeliest first
};

/// `tracklets` as tracked, by track and time, those cut off saying so (`goes_on`); `teams` of each: 0, 1, or −1 where it is not
/// known. `times` by instant. No tracklet is empty.
GroundIdentities identify(std::span<const GroundTracklet> tracklets, std::span<const int> teams, std::span<const Timestamp> times,
                          std::span<const IdentityAnnotation> namings, const GroundIdentityOptions& options = {});

}  // namespace marey::track::ground::offline
