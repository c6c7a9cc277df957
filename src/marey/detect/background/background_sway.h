#pragma once

#include <array>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/background/background_plane.h"
#include "marey/detect/background/background_shadow.h"

namespace marey::detect::background {

/// By how many whole pixels a shaking camera shows the scene beside where it was learned. The remainder, half a pixel, the
/// scene's bands allow for.
class SwayMeter {
 public:
  /// Another scene begins.
  void begin();

  /// The scene's light has changed: its edges are chosen again.
  void renew() { until_chosen_ = 0; }

  /// The image shows at (x + dx, y + dy) what the scene has at (x, y). (0, 0) where that explains the image as well.
  cv::Point measure(const cv::Mat& luma, const ScenePlane& scene);

 private:
  struct Edge {
    int x, y;
    bool across;  ///< whether the light changes from left to right; else from top to bottom
    int step;     ///< by how much, in levels
  };
  void choose(const ScenePlane& scene);
  int misfit(const cv::Mat& luma, cv::Point shift) const;
  cv::Point descend(const cv::Mat& luma, cv::Point from) const;

  std::vector<Edge> edges_;
  cv::Point last_;
  int until_chosen_ = 0;  ///< frames
};

/// `planes` as the scene has its places, for an image that is `shift` beside it. What lies outside the image is the scene
/// itself.
FramePlanes brought_back(const FramePlanes& planes, cv::Point shift, const ScenePlane& luma, const ScenePlane& cb,
                         const ScenePlane& cr);

/// What `mask`, in the scene's places, is in the image's.
void carry_over(const cv::Mat& mask, cv::Point shift, cv::Mat& result);

}  // namespace marey::detect::background
