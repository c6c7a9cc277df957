#pragma once

#include <cstdint>
#include <optional>

#include "marey/core/image.h"
#include "marey/simulate/people/people_renderer.h"

namespace marey::simulate {

/// A camera above the origin's near side that faces the origin: pinhole, no roll, no distortion. World: x to the right, y away
/// from the camera.
struct LevelCamera {
  cv::Size size{768, 576};  ///< px
  double focal = 1536;      ///< px
  double distance = 45;     ///< m from the origin
  double pitch = 0.38;      ///< rad downwards

  std::optional<people::Sighting> operator()(const Vector<3>& point) const;
  /// The point of the ground that is seen at a place of the image, m; nothing above the horizon.
  std::optional<Vector<2>> on_ground(const Vector<2>& location) const;
};

/// A mown lawn with white lines as the camera sees it: stripes, patches, blades where they are large enough to be seen. Colour.
Image draw_lawn(const LevelCamera& camera, std::uint64_t seed);

}  // namespace marey::simulate
