#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/core/keypoints.h"

namespace marey {

/// What one camera's images show of people, frame by frame. People have no identity: their order in a frame says nothing.
struct KeypointSequence {
  KeypointSet set;
  std::optional<cv::Size> size;                   ///< px, of the images, where that is known
  std::optional<double> rate_hz;                  ///< frames a second, where that is known
  std::vector<std::vector<Keypoints<2>>> frames;  ///< the people of each frame
  std::string from;                               ///< the file or folder, for messages
};

}  // namespace marey
