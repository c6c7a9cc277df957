// Body keypoints in images, as other programs write them: OpenPose's folder of JSON files (BODY_25, BODY_25B, COCO), COCO keypoints
// JSON (results, or annotations with their categories), AlphaPose's JSON, MMPose's JSON, DeepLabCut's and SLEAP's CSV; and as
// `marey track --targets keypoints` does: JSON lines and CSV.
#pragma once

#include <string>
#include <string_view>

#include "marey/core/keypoint_sequence.h"

namespace marey::format::keypoints {

/// Whether a path may hold keypoints: a folder with a .json file in it, or a .json, .jsonl or .csv file.
bool may_hold_keypoints(const std::string& path);

/// One camera's keypoints, known by their content. `set` names the keypoint set where the file does not; empty: by how many points
/// there are, and where two sets have as many, by the one with the shorter bones. A point without confidence is absent. Frame
/// numbers are the file's. Throws Error, one sentence with the file, for what is malformed, truncated or of an unknown set.
KeypointSequence read_keypoints(const std::string& path, std::string_view set = {});

/// Writes one camera's keypoints as COCO annotations with images and a category that names the points: third number of a point is
/// its visibility × presence, 0 for one that is absent. Throws Error if the file cannot be written.
void write_coco_keypoints(const KeypointSequence& sequence, const std::string& path);

}  // namespace marey::format::keypoints
