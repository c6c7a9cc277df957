// A recording's tracklets cut wherever identities may have been exchanged, as a graph: what ground_identities.h searches.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "marey/track/ground/ground_roles.h"
#include "marey/track/ground/offline/ground_identities.h"

namespace marey::track::ground::offline {

/// Names that were given, by their numbers.
using NameSet = std::bitset<256>;

struct SegmentGraph {
  struct Node {
    int tracklet = 0;
    std::int32_t first = 0, last = 0;  ///< instants, both included; last < first where nothing lies between two meetings
    RoleSum role;
    NameSet names;
  };
  /// Two tracklets met: each one's node before and after.
  struct Crossing {
    std::int32_t instant = 0;
    std::array<int, 2> before{}, after{};
    double log_odds = 0;  ///< of an exchange
  };
  /// An end and a beginning that may be one person's.
  struct Gap {
    int before = 0, after = 0;  ///< nodes
    double gain = 0;            ///< logarithm of how much likelier one person is than two
  };

  std::vector<Node> nodes;  ///< by tracklet, then by time
  std::vector<Crossing> crossings;
  std::vector<Gap> gaps;
  std::map<std::array<int, 2>, double> gain_of_gap;  ///< by its nodes
  std::vector<int> successors;                       ///< of each node the next one of its tracklet, or assign::kNoIndex
};

SegmentGraph graph_of_segments(std::span<const GroundTracklet> tracklets, std::span<const int> teams,
                               std::span<const Timestamp> times, std::span<const IdentityAnnotation> namings,
                               const GroundIdentityOptions& options);

}  // namespace marey::track::ground::offline
