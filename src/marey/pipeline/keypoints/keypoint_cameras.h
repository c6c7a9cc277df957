#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/core/rig.h"
#include "marey/pipeline/keypoints/keypoint_frames.h"

namespace marey::pipeline::keypoints {

/// Finds the keypoints in a camera's images: its `source` is a video or a folder of images.
using FindInImages = std::function<KeypointSequence(const RigCamera&, const Hooks&)>;

/// Where a camera's keypoints are: its `detections`, else its `source`.
std::string keypoint_file_of(const RigCamera& camera);

/// Which of a rig's cameras are read.
enum class Cameras { calibrated, all };

/// The keypoints of the rig's cameras; the rig is fitted to the images' sizes. `set` is that of files that do not
/// specify, `rate_hz` counts if neither the rig nor a file specifies it. A take is read too; a camera whose source is neither is
/// given to `find`, if there is one. Throws Error if a file cannot be read, fewer than two cameras have keypoints and the rig has
/// more than one that is calibrated, or keypoint sets differ.
std::vector<std::optional<KeypointCamera>> read_keypoint_cameras(Rig& rig, Cameras which, const std::string& set,
                                                                 std::optional<double> rate_hz, const FindInImages& find,
                                                                 const Hooks& hooks, std::vector<std::string>& warnings);

}  // namespace marey::pipeline::keypoints
