// A person's skeleton from a recording of body keypoints alone: how long the bones are, and where the points lie on head and feet,
// is taken from the whole recording, left and right alike; no static trial is needed.
#pragma once

#include <string>
#include <vector>

#include "marey/core/recording.h"
#include "marey/core/skeleton.h"

namespace marey::pipeline::keypoints {

/// The people whose keypoints a recording has, by what stands before the points' names: "" of one person, "P1:", "P2:", …; none
/// where its labels are not keypoints of a body (hips, knees and shoulders at least).
std::vector<std::string> people_with_keypoints(const std::vector<TrackName>& tracks);

/// The human skeleton of the person, with its joints beside the points where a network is known to put them elsewhere (BlazePose's
/// hips). `person` is what stands before the person's labels. Throws Error if a bone of the trunk or the legs is never seen
/// whole.
Skeleton skeleton_of_keypoints(const Recording& recording, const std::string& person);

}  // namespace marey::pipeline::keypoints
