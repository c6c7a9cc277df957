// BraMBLe beside our trackers: no detections, no association. Every particle says how many people there are and where; what it is
// worth is how much better it explains the pictures than an empty scene does.
//
// Source: Isard, MacCormick, "BraMBLe: A Bayesian Multiple-Blob Tracker", ICCV 2001. Neither that paper nor a copy was at hand:
// what follows is from memory and from what Queiroz et al. (OpenMoCap, section II) say of it. Remembered:
//   - responses of a filter bank on a grid; the likelihood is a product over the grid's points of the foreground's density where a
//     person is in front, of the background's elsewhere (detect/blobs): up to a factor, exp of the sum of log likelihood ratios
//     over the union of what people cover;
//   - people as generalised cylinders on the ground before a calibrated camera (person_cylinder.h);
//   - CONDENSATION over configurations whose number of people varies: they arrive and depart with given probabilities, keep an
//     identity, move with noise; two cannot stand in the same place;
//   - told is the mean of who is in most of the particles.
// Ours: several cameras (their log ratios add up); people sampled one after the other with a selection after each (MacCormick,
// Isard, "Partitioned sampling", ECCV 2000), without which the particles needed grow exponentially with people; arrivals proposed
// where evidence is left unexplained (blob_search.h), departures more often than they happen, both weighed accordingly; a share of
// the sum
// (`independence`) and a limit on each point, because neighbouring points and wrong models are no independent witnesses.
// Cost an instant: particles × people × cameras × the rows of the grid that a person spans.
#pragma once

#include <memory>

#include "marey/core/ground_views.h"
#include "marey/track/bramble/bramble_options.h"
#include "marey/track/tracker.h"

namespace marey::track::bramble {

/// Follows people by what `CameraObservations::evidence` says; `seen` is not looked at. What it decides has observations of its
/// own: where the particles have each person. `matches` of a step are empty. The same seed gives the same tracks, however many
/// threads there are. Throws Error where an option is out of its domain or a view is known by its homography alone: a person's
/// height in it must be known.
std::unique_ptr<Tracker<2>> make_bramble_tracker(const BrambleOptions& options, std::shared_ptr<const GroundViews> views);

}  // namespace marey::track::bramble
