#pragma once

#include <opencv2/core.hpp>

namespace marey {

/// What the background model says of each pixel of a frame.
struct Foreground {
  cv::Mat mask;  ///< CV_8UC1, 255 where something that does not belong to the scene is seen, 0 elsewhere; empty for none
  /// Of those, the pixels at least half of which it covers: the rim is trimmed. Empty if the model does not specify.
  cv::Mat covered = {};
};

}  // namespace marey
