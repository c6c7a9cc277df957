#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/core/keypoints.h"
#include "marey/geometry/camera.h"
#include "marey/reconstruct/sight_line.h"

namespace marey::reconstruct::keypoints {

/// A person in one camera's image as half-lines to the keypoints, in the order of the set; those that are absent have none.
struct PersonView {
  int camera = 0;
  int index = 0;  ///< among the people of that image
  std::vector<std::optional<SightLine>> points;
};

/// `noise` times the deviations that the keypoints state.
PersonView view_of(const Camera& camera, int number, int index, const Keypoints<2>& person, double noise);
std::optional<SightLine> line_of(const Camera& camera, int number, const Keypoint<2>& point, double noise);

/// What of a body a network exchanges with the other side: arms below the shoulder, legs below the hip.
enum class Limb { arms, legs };
/// Of each point of a set; nothing for points in the middle and those of the trunk and the head.
std::vector<std::optional<Limb>> limbs_of(const KeypointSet& set);

/// Which limbs of a view have the other side's names.
struct Mirrored {
  bool arms = false, legs = false;

  bool of(const std::optional<Limb>& limb) const {
    return limb && ((*limb == Limb::arms && arms) || (*limb == Limb::legs && legs));
  }
  bool operator==(const Mirrored&) const = default;
};

}  // namespace marey::reconstruct::keypoints
