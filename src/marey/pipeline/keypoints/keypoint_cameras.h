#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/core/rig.h"
#include "marey/pipeline/keypoints/keypoint_frames.h"

namespace marey::pipeline::keypoints {

/// Where a camera's keypoints are: its `detections`, else its `source`.
std::string keypoint_file_of(const RigCamera& camera);

/// The keypoints of the rig's calibrated cameras; the rig is fitted to the images' sizes. `set` is that of files that do not say,
/// `rate_hz` counts where neither the rig nor a file says. Throws Error where a file cannot be read, fewer than two calibrated
/// cameras have keypoints, or keypoint sets differ.
std::vector<std::optional<KeypointCamera>> read_keypoint_cameras(Rig& rig, const std::string& set, std::optional<double> rate_hz,
                                                                 std::vector<std::string>& warnings);

}  // namespace marey::pipeline::keypoints
