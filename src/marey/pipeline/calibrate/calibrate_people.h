// The job from videos of people, or their keypoints, to a rig.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/calibrate/people/people_rig.h"
#include "marey/core/hooks.h"
#include "marey/core/rig.h"
#include "marey/pipeline/calibrate/live_people.h"
#include "marey/pipeline/keypoints/keypoint_cameras.h"

namespace marey::pipeline::calibrate {

struct CalibratePeopleOptions {
  marey::calibrate::people::PeopleOptions how;
  std::string set;                ///< of files that do not specify it; empty: known by the points
  std::optional<double> rate_hz;  ///< where neither the rig nor the files say
  keypoints::FindInImages find;   ///< for cameras with videos
  LivePeopleOptions live;         ///< for cameras that are live
};

struct PeopleCalibration {
  marey::calibrate::people::PeopleRig found;
  std::vector<std::string> warnings;  ///< of the cameras' files, one sentence each
};

/// Where the rig's cameras stand, by people who walk before them: each camera's `detections` or `source` is a video, keypoints of
/// another program, or a take with keypoints. Where any `source` is live, all are: people are recorded before them until they were
/// seen enough, then the same is done with the videos. Throws Error if one cannot be read, and as
/// calibrate::people::calibrate_people does; Stopped.
PeopleCalibration calibrate_people(Rig rig, const CalibratePeopleOptions& options, const Hooks& hooks = {});

}  // namespace marey::pipeline::calibrate
