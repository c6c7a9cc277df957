// Following people on the ground: the same loop as in the image, D = 2 in metres, fed by every camera that observes the ground.
//
// An instant brings a view of each camera that has a frame for it. Views are taken in turn: in one view an observation is of one
// target at most and a target is seen once at most; between views a target may be matched again, by the other cameras. So one
// person has one identity across cameras, is passed  where they overlap, and two that hide each other from one camera are reported
// apart by another. The association within a view is one of three:
//   gnn   the one assignment of greatest likelihood (global nearest neighbour), at once and permanently;
//   jpda  each target is corrected by all observations in its gate, weighed by their marginal probabilities
//         (Fortmann, Bar-Shalom, Scheffe 1983), enumerated in clusters;
//   mht   several assignments are kept as hypotheses until what comes later decides between them (Reid 1979; Cox & Hingorani 1996:
//         the k best by Murty's method, clusters, N-scan pruning).
// All three share motion models, gates, costs, birth and death (ground_target.h), so that they can be compared.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "marey/core/ground_views.h"
#include "marey/filter/filters.h"
#include "marey/track/ground/ground_teams.h"
#include "marey/track/tracker.h"

namespace marey::track::ground {

/// On the ground, D = 2 in metres: camera i of the views is view i of the rig.
using CameraObservations = track::CameraObservations<2>;
using GroundDecision = track::Decision<2>;
using GroundTracker = track::Tracker<2>;
using track::ObservationMatch;

/// How observations find their targets.
enum class GroundAssociation { gnn, jpda, mht };

/// "gnn", "jpda", "mht". Throws Error, listing these, for another.
GroundAssociation ground_association_named(std::string_view name);

/// Lengths in m, times in s. What is not said of a person's motion comes from football and athletics.
struct GroundTrackerOptions {
  GroundAssociation associate = GroundAssociation::gnn;
  filter::FilterOptions filter = filter::KalmanOptions{.acceleration_noise = 2, .initial_speed = 3, .gate_sigmas = 3.5};
  EvidenceOptions evidence = {};
  double gate_probability = 0.999;  ///< that a target's own observation falls in its gate, in (0, 1)
  double max_speed = 12;            ///< m/s; no person runs faster
  double detected = 0.9;            ///< probability that a target in view of a camera is seen in one of its frames
  double clutter = 1e-4;            ///< false observations per m² and view
  double births = 1e-4;             ///< people who appear per m² and second; at the edge of what cameras see, more
  double disagreement = 0.3;        ///< by how much cameras may disagree about a place, permanently: standard deviation per axis
  std::optional<GroundTeams> teams = {};  ///< what the two teams wear, where that is known: evidence at every assignment
  double patience = 3;                    ///< a target that should be seen and is not is given up after this
  // For mht.
  int hypotheses = 50;  ///< kept for each cluster, at most
  double window = 1.0;  ///< N-scan: what is older than this is decided
};

/// `views`: how the cameras of the rig see the ground, asked for at the time of each frame; a target outside an image is not
/// missed by it. Throws Error if an option is out of its domain, or there is no camera.
std::unique_ptr<GroundTracker> make_ground_tracker(const GroundTrackerOptions& options, std::shared_ptr<const GroundViews> views);

}  // namespace marey::track::ground
