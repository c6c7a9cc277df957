// Who is who in the cameras' keypoints over a whole recording, instant by instant.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/core/keypoints.h"
#include "marey/geometry/camera.h"
#include "marey/pipeline/keypoints/keypoint_frames.h"
#include "marey/reconstruct/keypoints/person_path.h"

namespace marey::pipeline::keypoints {

struct TrackedPeople {
  std::map<int, reconstruct::keypoints::PersonTrack> tracks;
  std::int64_t detected = 0, located = 0;  ///< people in images
  std::vector<double> squares;             ///< of the triangulated points, per degree of freedom
  std::vector<double> times_ms;            ///< of each instant
};

using CalibratedCameras = std::vector<std::optional<Camera>>;  ///< nothing: it has no keypoints

/// By several cameras (people_in_views.h); `noise` times the deviations that the keypoints state.
TrackedPeople track_in_views(const CalibratedCameras& cameras, const KeypointFrames& frames, const KeypointSet& set, double noise,
                             const Hooks& hooks);
/// By the only camera that there is (one_camera.h).
TrackedPeople track_on_floor(const CalibratedCameras& cameras, const KeypointFrames& frames, const KeypointSet& set);

/// How many times the stated deviations the errors are, by how well rays meet: at the least noise with which most views are placed.
double keypoint_noise(const CalibratedCameras& cameras, const KeypointFrames& frames, const KeypointSet& set);

}  // namespace marey::pipeline::keypoints
