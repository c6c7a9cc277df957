// Following people on the ground: the same loop as in the image, D = 2 in metres, fed by every camera that looks at the ground.
//
// An instant brings a look of each camera that has a frame for it. Looks are taken in turn: in one look an observation is of one
// target at most and a target is seen once at most; between looks a target may be claimed again, by the other cameras. So one
// person has one identity across views, is handed over where they overlap, and two who hide each other from one camera are told
// apart by another. Who is whom within a look is decided by one of three associations:
//   gnn   the one assignment of greatest likelihood (global nearest neighbour), at once and for good;
//   jpda  each target is corrected by all observations in its gate, weighed by their marginal probabilities
//         (Fortmann, Bar-Shalom, Scheffe 1983), enumerated in clusters;
//   mht   several assignments are kept as hypotheses until what comes later decides between them (Reid 1979; Cox & Hingorani 1996:
//         the k best by Murty's method, clusters, N-scan pruning).
// All three share motion models, gates, costs, birth and death (ground_target.h), so that they can be compared.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/observation.h"
#include "marey/core/time.h"
#include "marey/core/track.h"
#include "marey/filter/filters.h"
#include "marey/geometry/ground_view.h"

namespace marey::track::ground {

/// What one camera saw of the ground in one frame.
struct CameraObservations {
  CameraId camera{};
  Timestamp time{};                           ///< of the frame, by the rig's clock: near the instant's, seldom equal
  std::span<const Observation<2>> seen = {};  ///< world's ground, m; `box` in px of this camera
};

/// Whose an observation of the last step was.
struct ObservationMatch {
  TrackId track{};
  int look = 0;         ///< index into the looks given
  int observation = 0;  ///< index into that look's `seen`
};

/// What a tracker has decided about an instant, never to be changed.
struct GroundDecision {
  Timestamp now{};
  std::span<const Track<2>> tracks = {};          ///< by id
  std::span<const ObservationMatch> claims = {};  ///< of the looks of that instant
};

/// What `step` and `claims` tell at once is the best guess of the moment. Who follows live takes that. Who records takes `decided`:
/// mht tells it later by its window, and may by then have found out that two who met had been taken for each other; gnn and jpda
/// decide at once, and tell the same as `step`. Each instant is decided once, in order.
class GroundTracker {
 public:
  virtual ~GroundTracker() = default;

  /// Takes in the looks of one instant and reports every target at `now`, in the order of ids, those not yet confirmed included and
  /// marked so; `Track::cameras` are those that saw it now, `observation` and `box` stay empty. Valid until the next call. A camera
  /// without a look has no frame for this instant: nobody is missed for it. Throws Error where `now` is not later than the last
  /// call's, or an observation is not finite.
  virtual std::span<const Track<2>> step(Timestamp now, std::span<const CameraObservations> looks) = 0;

  /// Who was seen where in the last step; only what belongs to a reported track. Valid until the next call.
  virtual std::span<const ObservationMatch> claims() const = 0;

  /// The instants that were decided in the last step. Valid until the next call of any kind.
  virtual std::span<const GroundDecision> decided() = 0;

  /// At the end of a recording: decides all instants that are left, and tells them. No step may follow.
  virtual std::span<const GroundDecision> decide_all() = 0;

  /// Where each confirmed target is expected at `now`. Valid until the next call of any kind.
  virtual std::span<const Track<2>> expected(Timestamp now) = 0;
};

/// How observations find their targets.
enum class GroundAssociation { gnn, jpda, mht };

/// "gnn", "jpda", "mht". Throws Error, listing these, for another.
GroundAssociation ground_association_named(std::string_view name);

/// Lengths in m, times in s. What is not said of a person's motion comes from football and athletics.
struct GroundTrackerOptions {
  GroundAssociation associate = GroundAssociation::gnn;
  filter::FilterOptions filter = filter::KalmanOptions{.acceleration_noise = 2, .initial_speed = 3, .gate_sigmas = 3.5};
  double gate_probability = 0.999;  ///< that a target's own observation falls in its gate, in (0, 1)
  double max_speed = 12;            ///< m/s; nobody runs faster
  double detected = 0.9;            ///< probability that somebody in view of a camera is seen in one of its frames
  double clutter = 1e-4;            ///< false observations per m² and look
  double births = 1e-4;             ///< people who appear per m² and second; at the edge of what cameras see, more
  double disagreement = 0.3;        ///< by how much cameras may disagree about a place, for good: standard deviation per axis
  double confident = 0.5;           ///< a target begins with scores of at least this; weaker ones only continue one
  double weak = 0.05;               ///< scores below this are not looked at
  double confirm = 3;               ///< evidence that makes a target: about so many confident observations
  double patience = 3;              ///< a target that should be seen and is not is given up after this
  // For mht.
  int hypotheses = 50;  ///< kept for each cluster, at most
  double window = 1.0;  ///< N-scan: what is older than this is decided
};

/// `views`: how camera i of the rig sees the ground; who stands outside its picture is not missed by it. Throws Error where an
/// option is out of its domain. Camera i of the looks is views[i].
std::unique_ptr<GroundTracker> make_ground_tracker(const GroundTrackerOptions& options, std::vector<GroundView> views);

}  // namespace marey::track::ground
