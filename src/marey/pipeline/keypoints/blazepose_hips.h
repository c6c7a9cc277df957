// BlazePose's hips lie below and inside those of other sets: thighs of 377 to 397 mm where OpenPose has 416 on the same videos.
#pragma once

namespace marey::pipeline::keypoints {

inline constexpr double kBlazeHipInwards_m = 0.010, kBlazeHipDown_m = 0.018;

}  // namespace marey::pipeline::keypoints
