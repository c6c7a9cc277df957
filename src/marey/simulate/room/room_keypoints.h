// What a network for body keypoints makes of the people in a room: their joints in every camera's image with the errors that such
// networks have. Each point lies beside its joint by as much in every frame (a lasting bias, another one in each camera), and
// trembles; some are missing, some are far off, and at times the left and the right arm or leg are exchanged.
#pragma once

#include <cstdint>
#include <vector>

#include "marey/core/keypoint_sequence.h"
#include "marey/simulate/room/body_pose.h"
#include "marey/simulate/room/room.h"

namespace marey::simulate::room {

struct KeypointErrors {
  double bias_m = 0.020;   ///< how far a point lies from its joint across the view, of each camera and point in its own direction
  double noise_px = 8;     ///< standard deviation along each axis, another one in each frame
  double outliers = 0.05;  ///< share of points that are far off
  double outlier_px = 60;  ///< by this much along each axis, one standard deviation
  double missing = 0.10;   ///< share of points
  double drift = 0;        ///< relative: cameras' clocks run by up to this much slower or faster than the first one's
  double readout_s =
      0;  ///< of a rolling shutter: the lowest row is exposed this much after the highest, the middle one at the frame's time
  double swapped = 0;  ///< share of time during which arms, or legs, are exchanged in a camera
};

/// Joints of a body as the keypoint set body_25b has them, m.
std::vector<Vector<3>> keypoint_positions(const BodyPose& pose);
const KeypointSet& room_keypoint_set();

/// Where the people's points truly are at a time by the rig's clock, by actor. The scene has people.
std::vector<std::vector<Vector<3>>> true_keypoints(const RoomScene& scene, double time_s);

/// What a camera's network finds at a time by the rig's clock: those of the people with at least half of their points in the
/// image, in an order that says nothing. `draw` is that of the noise: the frame's number.
std::vector<Keypoints<2>> keypoints_observed(const RoomScene& scene, int camera, double time_s, std::uint64_t draw,
                                             const KeypointErrors& errors = {});

/// How much slower a camera's clock runs, relative: frame k is exposed at k (1 + drift) / rate + offset.
double clock_drift(const RoomScene& scene, int camera, const KeypointErrors& errors);

/// All of a camera's frames.
KeypointSequence keypoints_of_camera(const RoomScene& scene, int camera, const KeypointErrors& errors = {});

}  // namespace marey::simulate::room
