// People in the pictures of one fixed camera: detect what does not belong to the scene where people are expected, follow it, and,
// once the whole recording is known, join, fill and smooth what was followed.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/detect/detectors.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/pipeline/keypoints/body_keypoints.h"
#include "marey/track/contour/outline_follower.h"
#include "marey/track/offline/join.h"
#include "marey/track/tracker.h"

namespace marey::pipeline::people {

struct PeopleInPictureOptions {
  detect::DetectorOptions detector = detect::people::PeopleDetectorOptions{};  ///< where the feed does not detect itself
  track::TrackerOptions tracker;
  track::offline::JoinOptions join;
  std::optional<keypoints::KeypointOptions> keypoints = {};  ///< look for everybody's body points too; pictures are needed for it
  std::optional<track::contour::OutlineOptions> outlines;    ///< follow outlines too, with these; pictures are needed for it
  /// Every frame's tracks are told as they come: nothing is read ahead and nothing improved by what came later.
  bool live = false;
  double delay = 0;         ///< s that a live run looks ahead before it tells a moment
  bool seen_only = false;   ///< rows of those whom nobody saw at that moment are left out
  std::string beside;       ///< outlines that wait for the second pass lie in a nameless file beside this path
  bool steady = false;      ///< the camera shakes: pictures are steadied first, and results are in the pixels of its rest
  bool with_lines = false;  ///< keep their measurement lines too, for an overlay
};

/// Detections are the feed's where it brings some (another program's, or those of a detector it was given), else of background
/// subtraction, which learns the empty scene from the feed first unless `live`. Memory grows with the rows, 76 bytes each, and with
/// nothing else; not even with those where `live`. Throws Error where outlines or keypoints are asked for of a feed without
/// pictures, and keypoints of one that cannot be read twice and is not `live`.
std::unique_ptr<corridor::Stage> people_in_picture(const corridor::Feed& feed, const PeopleInPictureOptions& options);

}  // namespace marey::pipeline::people
