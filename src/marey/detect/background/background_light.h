#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/background/background_plane.h"

namespace marey::detect::background {

/// A change of the scene's light from one frame to the next: a lamp, a cloud, a camera's exposure.
struct LightChange {
  cv::Mat gains;          ///< CV_32FC1, for each block of ScenePlane::kBlock pixels
  bool explained = true;  ///< false where the change is too great to be one of light: the scene itself is another
};

/// Compares frames with the scene on a sparse grid.
class LightMeter {
 public:
  /// The gain of the light of `luma` over `scene`; nothing if it is negligible. Levels count from `black`.
  std::optional<LightChange> measure(const cv::Mat& luma, const ScenePlane& scene, int black);

 private:
  struct Cell {
    std::vector<float> ratios;
    float gain = 1;
    bool sure = false;
  };
  void sample(const cv::Mat& luma, const ScenePlane& scene, int black);
  float overall();
  void assess(Cell& cell, float overall_gain);
  cv::Mat smoothed(float overall_gain) const;

  static constexpr int kColumns = 6, kRows = 4;
  std::vector<Cell> cells_{static_cast<std::size_t>(kColumns) * kRows};
  std::vector<float> all_;
};

/// The median of image − scene over a sparse grid, in levels.
double median_difference(const cv::Mat& image, const ScenePlane& scene);

}  // namespace marey::detect::background
