// Which tracklets on the ground are one person's, decided over the whole recording at once.
//
// Every tracklet begins because a person came into sight or because a person who had been lost was found again, and likewise ends.
// The chains of tracklets that explain all beginnings and ends best are a flow of least cost through the graph of tracklets; as
// every tracklet carries exactly one person, that is an assignment of ends to beginnings, each of which may stay alone. What a pair
// gains is a logarithm of likelihoods, one person against two:
//   motion     the state at the end, predicted over the gap by the damped walk of ground_smooth.h, meets the state at the beginning
//              (place and velocity, both with what is uncertain of them), against a person who comes from anywhere, anyhow;
//   time       lost people are found again sooner rather than later;
//   place      where people come into sight and leave it, they are likely to have done so; elsewhere they are not: that is learned
//              from the recording (entry_exit_map.h);
//   clothes    the two colours are as one person's, against how common such a colour is in this recording.
// No person is in two places at once, since a chain never goes back in time, and no person is faster than people are. Short gaps
// are settled first: what that joins is longer, and surer of its velocities and colours, when the long gaps follow. Cost: pairs
// within the longest gap, about 10 a tracklet, and a local search for each tracklet (sparse_assignment.h). References: Zhang, Li &
// Nevatia, "Global data association for multi-object tracking using network flows", CVPR 2008; Perera et al. 2006.
#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "marey/core/time.h"
#include "marey/track/ground/ground_teams.h"
#include "marey/track/ground/offline/ground_smooth.h"
#include "marey/track/ground/offline/ground_tracklet.h"

namespace marey::track::ground::offline {

/// Whether a person who stands there at that time would be seen and reported: within some camera's image, and on the pitch.
using InSight = std::function<bool(const Vector<2>&, Timestamp)>;

struct GroundChainOptions {
  double longest_gap = 20;  ///< s
  double max_speed = 12;    ///< m/s
  GroundMotion motion;
  std::optional<GroundTeams> teams = {};
};

/// What an end of a tracklet, or its beginning, shows about joining it.
struct GroundEnd {
  Timestamp time{};
  GroundState state;
  int piece = 0;                              ///< index of the tracklet
  bool goes_on = false;                       ///< the tracker thought that the next tracklet follows
  double coming = 5e-5;                       ///< people who come into sight there, per m² and s
  double leaving = 0.02;                      ///< of those whose tracks end there, the share who left permanently
  std::optional<Appearance> appearance = {};  ///< of the whole tracklet
};

/// How common each colour is among the people of a recording.
class GroundColours {
 public:
  /// `wears` of each tracklet that has a colour, with how long it was seen.
  struct Detected {
    Appearance clothing;
    double seconds = 0;
  };
  explicit GroundColours(std::span<const Detected> detected, const std::optional<GroundTeams>& teams = {});

  /// Logarithm of how much likelier it is that both are one person's than two people's; 0 where one is unknown.
  double same(const std::optional<Appearance>& a, const std::optional<Appearance>& b) const;

 private:
  std::vector<Detected> kinds_;
  std::optional<GroundTeams> teams_;
};

/// What an end may be off by beyond what its covariance says: standard deviations per axis.
struct EndpointError {
  double location = 0.4;  ///< m; a person about to be lost is half hidden already
  double speed = 0.9;     ///< m/s
};

/// Logarithm of how likely the one who made `tail` is to be found as `head` is: place, velocity and clothes. `tail` is the earlier.
double log_continuity(const GroundEnd& tail, const GroundEnd& head, const GroundColours& colours, const GroundMotion& motion,
                      const EndpointError& stray = {});

/// Every tracklet's beginning and its end, by their indices, from each one's first and last seconds.
std::pair<std::vector<GroundEnd>, std::vector<GroundEnd>> ends_of(std::span<const GroundTracklet> tracklets,
                                                                  std::span<const Timestamp> times, const GroundMotion& motion);

/// Logarithm of how much likelier it is that one person made both ends than that one left and another came; nothing if one
/// person cannot have.
std::optional<double> gain_of_joining(const GroundEnd& tail, const GroundEnd& head, const GroundColours& colours,
                                      const GroundChainOptions& options);

/// For each end the beginning that follows it, or assign::kNoIndex. `tails[i]` and `heads[i]` belong to one tracklet.
std::vector<int> best_links(std::span<const GroundEnd> tails, std::span<const GroundEnd> heads, const GroundColours& colours,
                            const GroundChainOptions& options);

/// Tracklets that are one person's.
struct GroundChain {
  std::vector<int> members;           ///< indices, in the order of time
  std::vector<double> probabilities;  ///< of each member but the first: that it is the same person as the one before
};

/// Chains in the order of their first samples. `times` by instant; no tracklet is empty.
std::vector<GroundChain> chain(std::span<const GroundTracklet> tracklets, std::span<const Timestamp> times, const InSight& in_sight,
                               const GroundChainOptions& options);

/// What a person wears by all samples: the median of each component. Nothing if no sample has a colour.
std::optional<Appearance> appearance_of(std::span<const GroundSample> samples);

}  // namespace marey::track::ground::offline
