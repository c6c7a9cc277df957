#pragma once

#include <optional>

#include "marey/reconstruct/sight_line.h"

namespace marey::reconstruct::keypoints {

/// Where two half-lines pass each other, and by how much.
struct RayPair {
  Vector<3> position = Vector<3>::Zero();  ///< m, midway
  double square = 0;                       ///< of both reprojection errors, in standard deviations: one degree of freedom
};

/// Nothing if they are parallel or pass behind a camera.
std::optional<RayPair> pass_of(const SightLine& a, const SightLine& b);

}  // namespace marey::reconstruct::keypoints
