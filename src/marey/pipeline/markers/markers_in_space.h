// Markers in space, from what the cameras of a calibrated rig saw of them: match blobs to predictions and to each other, place
// them, follow them, give them names, fill their gaps.
#pragma once

#include <memory>
#include <optional>

#include "marey/core/learned_markers.h"
#include "marey/core/rig.h"
#include "marey/core/skeleton.h"
#include "marey/detect/markers/marker_detector.h"
#include "marey/format/motion/marker_set.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/pipeline/markers/track_naming.h"
#include "marey/reconstruct/correspond.h"
#include "marey/track/roster/roster_tracker.h"

namespace marey::pipeline::markers {

/// What fits markers in space: m.
track::roster::RosterTrackerOptions space_tracker_options();

struct MarkersInSpaceOptions {
  detect::markers::MarkerOptions markers;
  reconstruct::CorrespondOptions correspond = {};
  std::optional<double> noise_px;  ///< of blobs and calibration together; nothing: learned from how well rays meet
  track::roster::RosterTrackerOptions tracker = space_tracker_options();
  MarkerSet set;                  ///< labels, with places where the markers keep their distances at the beginning; may be empty
  std::optional<double> rate_hz;  ///< of sources and observations that do not specify it
  double fill_s = 0.5;            ///< longest gap that is filled
  double predict_s = 0;           ///< of a longer gap, this much is reported as it was expected; ≤ fill_s
  /// Every instant is reported as it comes, and no gap is filled; its first `predict_s` are reported as they are expected. What a
  /// camera saw beside the instant is brought to it by the markers' motion.
  bool live = false;
  std::shared_ptr<TrackNaming> naming = {};                ///< names that markers are given by hand; null: none
  std::shared_ptr<const LearnedMarkers> learned_set = {};  ///< names the markers that have none, frame by frame; null: none
  bool waits_for_names = true;  ///< for the search in its task: results are then the same on any machine; not before live cameras
  std::shared_ptr<const Skeleton> skeleton;  ///< is solved from the labelled markers, instant by instant; null: none
};

/// `rig` as its feeds are. Instants wait for as long as the longest gap that is filled; memory does not grow with the recording.
/// Cameras without a calibration are omitted, with a warning. Throws Error if a skeleton is to be solved and no marker has a
/// name.
std::unique_ptr<corridor::Stage> markers_in_space(const Rig& rig, double rate_hz, const MarkersInSpaceOptions& options);

}  // namespace marey::pipeline::markers
