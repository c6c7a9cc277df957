#pragma once

#include <optional>

#include "marey/core/geometry.h"
#include "marey/geometry/camera.h"

namespace marey::reconstruct {

/// An upright person, m: what is taken for granted where nothing is known of who it is.
struct PersonShape {
  double height = 1.75;
  double width = 0.55;  ///< of the silhouette of a person who walks, from whichever side
};

/// The box of a person whose feet are at `foot` (m, in the world), as the camera sees it, px: also where it lies outside the
/// image. Nothing if the person is behind the camera or beyond what the lens shows.
std::optional<Box> person_box(const Camera& camera, const Vector<3>& foot, const PersonShape& shape = {});

}  // namespace marey::reconstruct
