#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/detection.h"
#include "marey/core/foreground.h"
#include "marey/core/frame.h"
#include "marey/core/observation.h"
#include "marey/core/outline.h"
#include "marey/core/track.h"
#include "marey/track/contour/colour/body_mask.h"

namespace marey::track::contour {

/// Lengths in px; noises in heights of the target, so that the same hold near the camera and far from it.
struct OutlineOptions {
  int order = 4;                      ///< degree + 1, 2 … 8
  std::optional<int> control_points;  ///< exactly this many; omitted: by tolerance, at most 40
  double tolerance = 0.3;             ///< px, RMS, between a silhouette's edge and the spline
  int lines = 24;                     ///< measurement lines
  double min_height = 8;              ///< px; smaller targets get no outline
};

/// Follows the outlines of the targets of another tracker: identities stay that tracker's task. A frame takes two calls:
///
///   const auto hints = outlines.observe(frame, seen.foreground, seen.detections);    // predict, search, correct
///   auto observations = observations_of(seen.detections);                         // detections first, hints after them
///   observations.insert(observations.end(), hints.begin(), hints.end());
///   const auto tracks = outlines.attach(tracker.step(frame.time, observations), seen.detections);
///
/// `observe` says what the outlines alone can say: an observation, too weak to begin a track, for each target that it found in the
/// image and that no detection explains (partly hidden, or its silhouette was rejected). `attach` takes the tracker's word for
/// who was seen and where: it begins outlines from two consecutive silhouettes, ends those of lost tracks, puts right an
/// outline that left its target, and returns the tracks with their outlines and, where the outline was seen, its box.
class ContourTracker {
 public:
  /// Throws Error if an option is out of its domain.
  explicit ContourTracker(const OutlineOptions& options = {});
  ~ContourTracker();
  ContourTracker(ContourTracker&&) noexcept;
  ContourTracker& operator=(ContourTracker&&) noexcept;

  /// Valid until the next call. Frames come in order; `foreground` may be empty (then light alone is searched).
  std::span<const Observation<2>> observe(const Frame& frame, const Foreground& foreground, std::span<const Detection> detections);

  /// A network that is asked for the pixels of every target, as one more likelihood; empty: none.
  void use_masks(colour::FindBodyMasks find);

  /// `tracks` of the frame last observed, whose `observation` counts detections first, then the observations `observe` returned.
  /// Valid until the next call. A track without an outline (not seen twice yet, too small, no usable silhouette) is returned as
  /// it came.
  std::span<const Track<2>> attach(std::span<const Track<2>> tracks, std::span<const Detection> detections);

 private:
  class Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace marey::track::contour
