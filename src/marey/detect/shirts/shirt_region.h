#pragma once

#include <optional>

#include "marey/core/instant.h"
#include "marey/core/keypoints.h"
#include "marey/detect/keypoints/person_region.h"

namespace marey::detect::shirts {

/// Where the number of a shirt is expected, and how large its person is.
struct ShirtRegion {
  keypoints::PersonRegion part;  ///< a square round the chest or the back, upright along the trunk
  double stature = 0;            ///< px; height of the standing person
};

/// Between shoulders and hips where these points are visible, else in the upper part of the box. Nothing without both, of a
/// person who lies or bends far, and of one whose box is wider than a standing person's.
std::optional<ShirtRegion> shirt_region(const Sample& sample, const std::optional<KeypointSet>& set);

/// The same of a box alone, px.
std::optional<ShirtRegion> shirt_region(const Box& box);

}  // namespace marey::detect::shirts
