#pragma once

#include <string>
#include <string_view>

#include "marey/core/rig.h"
#include "marey/geometry/pitch.h"

namespace marey::format::rig {

/// One camera as SoccerNet's camera calibration keeps it: JSON with pan, tilt and roll in degrees (turns about z, x, z), the place
/// in m from the pitch's middle, x to the right goal, y to the near touchline and z down, focal lengths and principal point in px,
/// and OpenCV's distortion. `size`: of the pitch, in whose corner our world has its origin. Throws Error for another lens than
/// brown.
std::string soccernet_camera_text(const Camera& camera, const geometry::PitchSize& size);

/// The same back. The image's size is not in the file: it is twice the principal point. Throws Error, `name` in front, where
/// something is missing or cannot be, and for thin prism distortion, which our lenses do not have.
Camera parse_soccernet_camera(std::string_view text, const std::string& name, const geometry::PitchSize& size);

}  // namespace marey::format::rig
