// Body keypoints of several live cameras, in space, instant by instant: a stage of the corridor.
//
// Each camera's people are searched in the regions that its last image gave (camera_people.h), all cameras' regions by one pool of
// threads. The people in each camera, and where their points are, come from the parts that serve recordings too
// (reconstruct/keypoints/people_in_views.h); a causal filter follows each point (located_people.h). A person that a camera has
// lost, or who enters its image, is searched for where the others place them; the person detector runs only when a region has
// ended, when a camera sees no person, and every few seconds, in one image of an instant at most. Cost: one run of the landmark
// network for each person and camera.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "marey/core/keypoint_sets.h"
#include "marey/core/rig.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/pipeline/keypoints/images_with_people.h"
#include "marey/pipeline/keypoints/located_people.h"

namespace marey::pipeline::keypoints {

struct KeypointsLiveOptions {
  std::string model = "lite";   ///< the landmark network: lite, full, heavy, or an ONNX file
  std::string detector;         ///< the file that describes the person detector; empty: the one that script/model makes
  FindPeople find_people = {};  ///< in place of `detector`
  FindBodies find_bodies = {};  ///< in place of `model`
  KeypointSet set = keypoint_set_named("blazepose");  ///< of `find_bodies`
  CameraPeopleOptions cameras = {};
  LocatedPeopleOptions people = {};
  double gate_slack = 1.3;               ///< factor of the noise for the association, as for recordings
  double min_visibility = 0.5;           ///< of a point that is reported as seen by a camera, unswept
  double max_residual = 0.1;             ///< of a person on whose points all cameras agree: median, of their extent, unswept
  std::size_t min_points_in_image = 12;  ///< of a person that is searched in another camera's image, unswept
};

/// `rig` as its feeds are. Cameras without a calibration are not used, with a warning. Tracks are in space, "P1:left_knee",
/// "P2:left_knee", …, and each instant has what the cameras saw of them. Throws Error if fewer than two cameras are calibrated, or
/// if a network is not usable.
std::unique_ptr<corridor::Stage> keypoints_live(const Rig& rig, double rate_hz, const KeypointsLiveOptions& options);

}  // namespace marey::pipeline::keypoints
