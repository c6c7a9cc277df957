// One person's whole motion: each keypoint's path (trajectory.h), which limbs of which view bear the other side's names as the
// whole motion has it, and how far off the points are.
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
  std::vector<PlacedPerson> instants;
};

/// The keypoints of a person in a camera at an instant; nothing where the camera does not see them.
using FindKeypoints = std::function<const Keypoints<2>*(std::size_t instant, int camera, int index)>;

struct PersonPathOptions {
  TrajectoryOptions trajectory;
  double swap_gain = 3;  ///< standard deviations that a limb must fit better exchanged
  double noise = 1;      ///< times the deviations that the keypoints state
};

struct PersonPath {
  std::vector<std::vector<TrajectoryPoint>> points;  ///< by the set, then by instant; empty for a point that is never placed
  std::vector<double> squares;                       ///< of all errors, in standard deviations (`append_squares`)
};

/// Corrects `track.instants[…].mirrored`.
PersonPath path_of(PersonTrack& track, const KeypointSet& set, std::span<const std::optional<Camera>> cameras,
                   const FindKeypoints& find, double step_s, const PersonPathOptions& options = {});

}  // namespace marey::reconstruct::keypoints
