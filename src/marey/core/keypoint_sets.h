// The keypoint sets that programs use, under names that are the same in all of them: "left_knee" is the left knee in each.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/keypoints.h"

namespace marey {

/// body_25 and body_25b (OpenPose), coco_18 (OpenPose), coco (17 points), halpe_26 (AlphaPose, RTMPose), blazepose (MediaPipe).
std::span<const KeypointSet> keypoint_sets();
/// Throws Error, with the names that there are.
const KeypointSet& keypoint_set_named(std::string_view name);
/// "body_25, body_25b, …": for help and messages.
std::string keypoint_set_names();

/// A set of points with these names; the bones are those of a human body between points that it has.
KeypointSet keypoint_set_of(std::string name, std::vector<std::string> points);
/// The common name of a point as any program calls it: "LKnee", "l_knee", "left-knee" and "knee_left" are "left_knee".
std::string common_keypoint_name(std::string_view name);

/// Index of the point of that name.
std::optional<int> point_named(const KeypointSet& set, std::string_view point);

}  // namespace marey
