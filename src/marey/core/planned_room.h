#pragma once

#include <optional>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/core/geometry.h"

namespace marey {

/// A box along the world's axes, m.
struct RoomBox {
  Vector<3> from = Vector<3>::Zero(), to = Vector<3>::Zero();  ///< each coordinate of `from` below that of `to`
};

/// A room for which cameras are planned: where things move, and where cameras may be.
struct PlannedRoom {
  RoomBox volume;                    ///< in which every point counts the same
  std::vector<Vector<3>> mounts;     ///< m; places for a camera
  std::vector<RoomBox> obstacles;    ///< that nothing is seen through
  int cameras = 4;                   ///< how many are to be placed
  cv::Size size = {1920, 1080};      ///< px, of their images
  double field_of_view = 1.15;       ///< rad, across the image
  double noise_px = 0.5;             ///< standard deviation of a detection, of each coordinate
  std::optional<double> farthest_m;  ///< at which a camera still detects the target
  bool facing = true;                ///< points sit on bodies, which hide them from behind
};

}  // namespace marey
