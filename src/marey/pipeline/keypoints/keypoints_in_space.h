// The job from body keypoints in several calibrated cameras' images to the same keypoints in space: identities across cameras
// (reconstruct/keypoints/people_in_views.h), where each point is at each instant, and each point's path (…/person_path.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/core/recording.h"
#include "marey/core/rig.h"
#include "marey/pipeline/keypoints/keypoint_cameras.h"

namespace marey::pipeline::keypoints {

struct KeypointsInSpaceOptions {
  std::string set;                ///< of the files, where they do not specify; empty: known by the points
  std::optional<double> rate_hz;  ///< where neither the rig nor the files say
  int people = 0;                 ///< the most that are kept: those in the most views; 0: all
  bool smooth = true;             ///< paths over all instants; else each instant by itself
  bool find_offsets = true;       ///< of cameras of which the rig has none, by the motion of the points
  double farthest_offset_s = 0.5;
  FindInImages find;        ///< for cameras with videos in place of keypoints; none: they are refused
  double fill_s = 0.2;      ///< the longest gap that is filled
  double shortest_s = 0.2;  ///< the one who is placed for less is omitted
};

struct KeypointsSummary {
  struct Person {
    std::string label;
    std::int64_t instants = 0;
    double views = 0;  ///< on the mean of these
  };
  struct Camera {
    std::string name;
    std::int64_t frames = 0, people = 0, located = 0;  ///< people in its images, and those of them that were placed
    double residual_px = 0;                            ///< median distance between its keypoints and those in space
    double noise = 0;                                  ///< the same, times what keypoints of their confidence have
    std::int64_t swapped = 0;                          ///< limbs that were read with left and right exchanged
    std::optional<double> offset_s, offset_sigma_s;    ///< where it was found
  };
  std::string set;
  int points = 0;  ///< of a person
  std::int64_t frames = 0;
  double seconds = 0, rate_hz = 0;
  std::vector<Person> people;
  std::vector<Camera> cameras;
  std::int64_t measured = 0, filled = 0;
  std::int64_t views = 0, located = 0;
  double residual_px = 0;   ///< median
  double noise = 0;         ///< how many times the deviation that the files state
  double position_ms = 0;   ///< of association and triangulation, a frame, median
  bool one_camera = false;  ///< feet on the floor, bodies in a plane that faces the camera
  std::vector<std::string> warnings;
  bool stopped = false;
};

/// The keypoints of the rig's cameras: each camera's `detections` or `source` names a file or folder of them
/// (format/keypoints/keypoint_file.h), a take, or with `find` a video. If the rig's only calibrated camera has them, its people
/// stand on the floor, z = 0 (reconstruct/keypoints/one_camera.h), and warnings and `made_by` state that. Labels are the points'
/// names, of several people "P1:left_knee". Throws Error if a file cannot be read, fewer than two calibrated cameras have
/// keypoints, sets differ, or no person is seen by two cameras.
Recording keypoints_in_space(const Rig& rig, const KeypointsInSpaceOptions& options, KeypointsSummary& summary,
                             const Hooks& hooks = {});

/// The same, and writes it in the format of the ending.
KeypointsSummary reconstruct_keypoints(const Rig& rig, const std::string& out, const KeypointsInSpaceOptions& options = {},
                                       const Hooks& hooks = {});

}  // namespace marey::pipeline::keypoints
