// BraMBLe: no detections, no association. Every particle says how many people there are and where; what it is
// worth is how much better it explains the images than an empty scene does.
//
// Source: Isard, MacCormick, "BraMBLe: A Bayesian Multiple-Blob Tracker", ICCV 2001. Neither that paper nor a copy was at hand:
// what follows is from memory and from what Queiroz et al. (OpenMoCap, section II) say of it. Remembered:
//   - responses of a filter bank on a grid; the likelihood is a product over the grid's points of the foreground's density where a
//     person is in front, of the background's elsewhere (detect/blobs): up to a factor, exp of the sum of log likelihood ratios
//     over the union of what people cover;
//   - people as generalised cylinders on the ground before a calibrated camera (person_cylinder.h);
//   - CONDENSATION over configurations whose number of people varies: they arrive and depart with given probabilities, keep an
//     identity, move with noise; two cannot stand in the same place;
//   - the output is the mean of the people in most of the particles.
// Ours: several cameras (their log ratios add up); people sampled one after the other with a selection after each (MacCormick,
// Isard, "Partitioned sampling", ECCV 2000), without which the particles needed grow exponentially with people; arrivals proposed
// where evidence is left unexplained (blob_search.h), departures more often than they happen, both weighed accordingly; a share of
// the sum
// (`independence`) and a limit on each point, because neighbouring points and wrong models are not independent witnesses.
// Cost an instant: particles × people × cameras × the rows of the grid that a person spans.
#pragma once

#include <memory>
#include <span>

#include "marey/core/blob_evidence.h"
#include "marey/core/ground_views.h"
#include "marey/track/bramble/bramble_options.h"
#include "marey/track/tracker.h"

namespace marey::track::bramble {

/// What one camera's image says at an instant.
struct CameraEvidence {
  CameraId camera{};
  Timestamp time{};                              ///< of the frame, by the rig's clock
  std::shared_ptr<const BlobEvidence> evidence;  ///< null: none yet
};

/// Tracks people on the ground. The same seed gives the same tracks, however many threads there are.
class BrambleTracker {
 public:
  /// Throws Error if an option is out of its domain or a view is known by its homography alone: a person's height in it must be
  /// known.
  BrambleTracker(const BrambleOptions& options, std::shared_ptr<const GroundViews> views);
  ~BrambleTracker();
  BrambleTracker(BrambleTracker&&) noexcept;

  /// The people at an instant, those not yet confirmed marked so. `views`: of the cameras that have a frame. Valid until the next
  /// call. Throws Error if `now` is not later than the last call's.
  std::span<const Track<2>> step(Timestamp now, std::span<const CameraEvidence> views);

  /// As if the cameras had observed people where the particles have them, each that sees a person with an equal share of what is
  /// known of them. Of the last step.
  std::span<const CameraObservations<2>> observations() const;
  std::span<const ObservationMatch> matches() const;  ///< of `observations`

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace marey::track::bramble
