// People in the images of one fixed camera: detect what does not belong to the scene where people are expected, follow it, and,
// once the whole recording is known, join, fill and smooth what was followed.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/detect/detectors.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/pipeline/keypoints/body_keypoints.h"
#include "marey/track/contour/contour_tracker.h"
#include "marey/track/offline/join.h"
#include "marey/track/tracker.h"

namespace marey::pipeline::people {

struct ImagePeopleOptions {
  detect::DetectorOptions detector = detect::people::PeopleDetectorOptions{};  ///< where the feed does not detect itself
  track::TrackerOptions tracker;
  track::offline::JoinOptions join;
  std::optional<keypoints::KeypointOptions> keypoints =
      {};                                                  ///< search for every person's body points too; images are needed for it
  std::optional<track::contour::OutlineOptions> outlines;  ///< follow outlines too, with these; images are needed for it
  std::string contour_model = {};  ///< a landmark network (lite, full, heavy, FILE.onnx) whose masks help contours; empty: none
  /// Every frame's tracks are reported as they come: nothing is read ahead and nothing improved by what came later.
  bool live = false;
  double delay = 0;            ///< s that a live run uses later frames before it reports an instant
  bool observed_only = false;  ///< rows of those not observed at that instant are omitted
  std::string spill_path;      ///< outlines that wait for the second pass lie in a nameless file beside this path
  bool stabilise = false;      ///< the camera shakes: images are stabilised first, and results are in the pixels of its rest
  bool with_lines = false;     ///< keep their measurement lines too, for an overlay
};

/// Detections are the feed's where it brings some (another program's, or those of a detector it was given), else of background
/// subtraction, which learns the empty scene from the feed first unless `live`. Memory grows with the rows, 76 bytes each, and with
/// nothing else; not even with those where `live`. Throws Error if outlines or keypoints are asked for of a feed without
/// images, and keypoints of one that cannot be read twice and is not `live`.
std::unique_ptr<corridor::Stage> people_in_image(const corridor::Feed& feed, const ImagePeopleOptions& options);

}  // namespace marey::pipeline::people
