#pragma once

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"

namespace marey {

/// What an image says of each point of a grid over it: whether something that does not belong to the scene is seen there.
struct BlobEvidence {
  Vector<2> origin = Vector<2>::Zero();  ///< px; of the grid's first point
  double step = 1;                       ///< px between neighbours
  /// CV_32FC1, rows × columns of points: ln p(response | foreground) − ln p(response | background), in nats.
  cv::Mat log_ratio;
};

}  // namespace marey
