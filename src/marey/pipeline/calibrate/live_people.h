// People who walk before live cameras, kept as videos, while a fast network says what has been seen of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/core/keypoint_sequence.h"
#include "marey/core/rig.h"
#include "marey/pipeline/calibrate/live_observed.h"
#include "marey/pipeline/keypoints/images_with_people.h"
#include "marey/pipeline/live/camera_settings.h"

namespace marey::pipeline::calibrate {

struct LivePeopleOptions {
  std::string folder;                               ///< NAME.mp4 of each camera, and rig.toml, which is of them
  std::string model = "lite", detector = {};        ///< the networks that watch (images_with_people.h)
  keypoints::FindPeople find_people = {};           ///< in place of `detector`
  keypoints::FindBodies find_bodies = {};           ///< in place of `model`
  live::CameraSettings* camera_settings = nullptr;  ///< by which cameras are set in the meantime; else they stay as the rig says
  double patience_s = 5;                            ///< that cameras are waited for at the beginning
  double walk_s = 600;                              ///< people walk until they were seen enough, at most this long
  /// Ten times a second; false: that will do. May be empty.
  std::function<bool(const LiveObserved&)> walking = {};
  std::function<void()> walked = {};  ///< the rest is computed. May be empty
};

struct RecordedPeople {
  Rig rig;  ///< as the cameras are, but for their sources, the videos, and the offsets and rates at which these were taken
  std::vector<std::vector<double>> times_s;  ///< by camera: of its video's frames, by one clock
  std::vector<std::string> missing;          ///< where it was ended before it was enough: where people should have walked yet
};

/// Throws Error if a camera gives no frame, or the videos cannot be written; Stopped.
RecordedPeople record_people(Rig rig, const LivePeopleOptions& options, const Hooks& hooks);

/// The keypoints of a video's frames, each in the place that its time has at an even rate: what a camera has lost is a frame
/// without people.
KeypointSequence by_times(KeypointSequence sequence, std::span<const double> times_s, double rate_hz);

}  // namespace marey::pipeline::calibrate
