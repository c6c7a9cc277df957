#pragma once

#include <memory>
#include <span>

#include "marey/core/observation.h"
#include "marey/core/time.h"
#include "marey/core/track.h"
#include "marey/filter/filters.h"

namespace marey::track {

/// Follows many targets: observations of one instant in, tracks out. D = 2 in the image (px) and on the ground (m), 3 in space.
template <int D>
class Tracker {
 public:
  virtual ~Tracker() = default;

  /// Takes in what was seen at `now` and reports every target that is followed, in the order of their ids, those not yet
  /// confirmed included and marked so. The span stays valid until the next call. Throws Error where `now` is not later than the
  /// last call's or an observation is not finite.
  virtual std::span<const Track<D>> step(Timestamp now, std::span<const Observation<D>> seen) = 0;

  /// Where each confirmed target is expected at `now`, before it is looked at. Valid until the next call.
  virtual std::span<const Track<D>> expected(Timestamp now) = 0;
};

/// Lengths are in sizes of the target where observations carry a box (its height in the image: a standing person moves as many
/// body heights a second near the camera as far from it), else in the unit of the observations (px or m).
struct TrackerOptions {
  filter::FilterOptions filter = filter::KalmanOptions{.acceleration_noise = 0.45, .initial_speed = 0.8, .gate_sigmas = 3.5};
  double gate_probability = 0.999;  ///< that a target's own observation falls in its gate, in (0, 1)
  double max_speed = 7;             ///< nothing moves faster, sizes/s: 12 m/s for a person
  double place_noise = 0.04;        ///< standard deviation of a box's centre, sizes, at least
  double size_noise = 0.1;          ///< standard deviation of the logarithm of a box's width and height
  double size_drift = 0.15;         ///< what that logarithm may change by in a second
  double confident = 0.5;           ///< a target begins with scores of at least this; weaker ones only continue one
  double weak = 0.05;               ///< scores below this are not looked at
  double confirm = 3;               ///< evidence that makes a target: about so many confident observations
  double patience = 2.5;            ///< a target that should be seen and is not is given up after this, s
  bool steady_camera = false;       ///< true where the camera is known to stand still; else its turning is read off the targets
  /// Somebody new is taken for a target of his size that vanished near there. For a camera that stands still, where tracks are not
  /// joined afterwards with both sides known.
  bool reclaim = false;
  double hidden_patience = 3;  ///< one that is hidden behind another or in a shared region after this, s
};

/// What fits points without an extent, such as markers: lengths in px.
TrackerOptions point_tracker_options();

/// The tracker that the options choose. Throws Error where an option is out of its domain.
template <int D>
std::unique_ptr<Tracker<D>> make_tracker(const TrackerOptions& options);

}  // namespace marey::track
