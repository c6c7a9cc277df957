#pragma once

#include <opencv2/core/types.hpp>

#include "marey/detect/network/network_options.h"

namespace marey::detect::network {

/// What a network costs on this computer, before a run.
struct NetworkCost {
  double tile_s = 0;  ///< a tile of the image, where all threads have one each: wall time over tiles
  int tiles = 0;      ///< all over an image, while the size of people is not known
  int threads = 1;
  double frame_s() const { return tile_s * tiles; }
};

/// Loads the network and runs it on a few grey tiles. Throws Error as the detector does.
NetworkCost network_cost(const NetworkDetectorOptions& options, cv::Size image);

}  // namespace marey::detect::network
