#pragma once

#include <memory>
#include <optional>
#include <span>

#include "marey/core/ids.h"
#include "marey/core/observation.h"
#include "marey/core/time.h"
#include "marey/core/track.h"
#include "marey/filter/filters.h"
#include "marey/geometry/similarity2.h"
#include "marey/track/evidence.h"
#include "marey/track/image/box_noise.h"

namespace marey::track {

/// What one camera saw at an instant. Where all cameras were joined before, as in space, that counts as one camera.
template <int D>
struct CameraObservations {
  CameraId camera{};
  Timestamp time{};                               ///< of the frame, by the rig's clock: near the instant's, rarely equal
  std::span<const Observation<D>> detected = {};  ///< `box` in px of this camera
};

/// Which track an observation of the last step belongs to.
struct ObservationMatch {
  TrackId track{};
  int view = 0;         ///< index into the views given
  int observation = 0;  ///< index into that view's `seen`
};

/// What a tracker has decided about an instant, never to be changed.
template <int D>
struct Decision {
  Timestamp now{};
  std::span<const Track<D>> tracks = {};           ///< by id
  std::span<const ObservationMatch> matches = {};  ///< of the views of that instant
};

/// Follows many targets: observations of one instant in, tracks out. D = 2 in the image (px) and on the ground (m), 3 in space.
///
/// What `step` and `matches` give at once is the best guess of the instant: a live run takes that. A recording takes `decided`: a
/// tracker that keeps several hypotheses decides later, and may by then have found that two targets that met had been taken for
/// each other; others decide at once, and give the same as `step`. Each instant is decided once, in order.
template <int D>
class Tracker {
 public:
  virtual ~Tracker() = default;

  /// Takes in the views of one instant and returns every target that is followed, in the order of ids, those not yet confirmed
  /// included and marked so. In the image and in space there is one view; on the ground a camera without a view has no frame for
  /// this instant, and misses nothing. Valid until the next call. Throws Error if `now` is not later than the last call's, or
  /// an observation is not finite.
  virtual std::span<const Track<D>> step(Timestamp now, std::span<const CameraObservations<D>> views) = 0;

  /// The same with one view, of the first camera at that very time.
  std::span<const Track<D>> step(Timestamp now, std::span<const Observation<D>> detected) {
    const CameraObservations<D> view{CameraId{}, now, detected};
    return step(now, std::span(&view, 1));
  }

  /// The observations of the last step that belong to a track returned. Valid until the next call.
  virtual std::span<const ObservationMatch> matches() const = 0;

  /// The instants that were decided in the last step. Valid until the next call of any kind.
  virtual std::span<const Decision<D>> decided() = 0;

  /// At the end of a recording: decides and returns all instants that are left. No step may follow.
  virtual std::span<const Decision<D>> decide_all() = 0;

  /// Where the scene as it was seen first, continued to all sides, lies in the last frame: what the camera's pan, tilt, zoom and
  /// roll did since. The identity where none of them is followed.
  virtual geometry::Similarity2 view_from_scene() const { return {}; }

  /// What has been learned of how boxes err; nothing if nothing is.
  virtual std::optional<image::BoxNoise> learned_noise() const { return std::nullopt; }

  /// Where each confirmed target is expected at `now`, before it is observed. Valid until the next call of any kind.
  virtual std::span<const Track<D>> expected(Timestamp now) = 0;
};

/// Lengths are in sizes of the target where observations carry a box (its height in the image: a standing person moves as many
/// body heights a second near the camera as far from it), else in the unit of the observations (px or m).
struct TrackerOptions {
  filter::FilterOptions filter = filter::KalmanOptions{.acceleration_noise = 0.45, .initial_speed = 0.8, .gate_sigmas = 3.5};
  EvidenceOptions evidence = {};
  double gate_probability = 0.999;  ///< that a target's own observation falls in its gate, in (0, 1)
  double max_speed = 7;             ///< nothing moves faster, sizes/s: 12 m/s for a person
  double position_noise = 0.04;     ///< standard deviation of a box's centre, sizes, at least
  double size_noise = 0.1;          ///< standard deviation of the logarithm of a box's width and height
  double size_drift = 0.15;         ///< what that logarithm may change by in a second
  double patience = 2.5;            ///< a target that should be seen and is not is given up after this, s
  bool stabilised_camera = false;   ///< true where the camera is known to stand still; else its motion is read off the targets
  /// Noises of places, sizes and motion are learned from the boxes; those given here count until more is known.
  bool learn_noise = false;
  /// Where people are few for the room they have, who appears near where one is expected is likelier to be that one: by how many
  /// boxes the images hold. For a live run; a second pass does better with pieces that are surely one person's.
  bool learn_clutter = false;
  /// A newcomer is taken for a target of its size that vanished near there. For a static camera still, where tracks are not
  /// joined afterwards with both sides known.
  bool reidentify = false;
  double fading = 0.6;         ///< s unseen after which a target is e times less likely to be there
  double hidden_patience = 3;  ///< a target hidden behind another, or in a shared region, is given up after this, s
};

/// The same for boxes of another program's detector, which errs more, and misses a target for longer, than silhouettes do; what
/// was set to other than its default stays. Sweep: bench/tuning.md.
TrackerOptions box_tracker_options(TrackerOptions options = {});

/// What fits points without an extent, such as markers: lengths in px.
TrackerOptions point_tracker_options();

/// Follows targets in the image of one camera. Throws Error if an option is out of its domain.
std::unique_ptr<Tracker<2>> make_tracker(const TrackerOptions& options);

}  // namespace marey::track
