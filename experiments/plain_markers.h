// The obvious method, to compare with: pixels above half of the image's brightest are markers, their centroids are
// followed by constant-velocity Kalman filters that never stop coasting, and the Hungarian method pairs both.
#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/core/observation.h"
#include "marey/evaluate/label_loss.h"

namespace marey::experiments {

/// Centroids of the connected components above half of the brightest pixel, of at least 2 px. `image`: CV_8UC1.
std::vector<Observation<2>> plain_detections(const cv::Mat& image);

/// Follows the points of its first frame, and no others.
class PlainTracker {
 public:
  /// The places of all targets after this frame's points, 1/30 s after the last.
  std::vector<evaluate::NamedPosition> step(std::span<const Observation<2>> detected);

 private:
  struct Target {
    Eigen::Vector4d state;  // x, y, px, and their velocities, px a frame
    Eigen::Matrix4d covariance;
  };

  std::vector<Target> targets_;
};

}  // namespace marey::experiments
