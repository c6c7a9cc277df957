// One person's whole motion: each keypoint's path (trajectory.h), which limbs of which view have the other side's names, and how
// far off each camera's points lie for a while.
//
// A network puts a point beside its joint, by about as much as long as it sees the body from about the same side, and a calibration
// that is a little wrong does the same. Where a camera's point then is missing for a frame, or has less weight, the place in space
// would jump. So the first paths are made with wide deviations, in which every camera has its say; of every camera and point the
// mean error over three seconds is taken out; and the final paths are made of the rest, with the deviation that it shows. The
// mean over all cameras stays: what they share cannot be known. Cost: three times that of the paths.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "marey/core/keypoints.h"
#include "marey/reconstruct/keypoints/people_in_views.h"
#include "marey/reconstruct/keypoints/trajectory.h"

namespace marey::reconstruct::keypoints {

/// The instants of one person, from the first at which they are placed to the last; at some they may have no view.
struct PersonTrack {
  int id = 0;
  std::size_t first = 0;  ///< the instant of `instants[0]`
  std::vector<LocatedPerson> instants;
};

/// The keypoints of a person in a camera at an instant; nothing if the camera does not see them.
using FindKeypoints = std::function<const Keypoints<2>*(std::size_t instant, int camera, int index)>;

struct PersonPathOptions {
  TrajectoryOptions trajectory;
  double swap_gain = 3;  ///< standard deviations that a limb must fit better exchanged
  double noise = 1;      ///< times the deviations that the keypoints state: how well single instants' half-lines meet
  double lasting_s = 3;  ///< over which a camera's errors are averaged; 0: they are left in
};

struct PersonPath {
  std::vector<std::vector<TrajectoryPoint>> points;  ///< by the set, then by instant; empty for a point that is never placed
  double noise = 1;                                  ///< times the deviations that the keypoints state, as the paths show it
};

/// Corrects `track.instants[…].mirrored`.
PersonPath path_of(PersonTrack& track, const KeypointSet& set, std::span<const std::optional<Camera>> cameras,
                   const FindKeypoints& find, double step_s, const PersonPathOptions& options = {});

}  // namespace marey::reconstruct::keypoints
