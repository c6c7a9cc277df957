#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/background/background_plane.h"

namespace marey::detect::background {

/// Finds parts of a picture that lie in another light than the scene: the shadows of clouds, a lamp's cone, the sun through a
/// window.
class LightPatches {
 public:
  /// The gain of the light of `luma` over `scene`, CV_32FC1, for the cells of a grid that covers the picture evenly; nothing where
  /// it is 1 everywhere. Levels count from `black`.
  std::optional<cv::Mat> measure(const cv::Mat& luma, const ScenePlane& scene, int black);

 private:
  struct Cell {
    int count = 0;
    int frame = 0, scene = 0, frame2 = 0, scene2 = 0, both = 0;  ///< sums of levels over black, their squares and products
  };
  enum class Answer { unknown, as_before, other };
  static Answer judge(const Cell& cell, float& gain);
  void sample(const cv::Mat& luma, const ScenePlane& scene, int black);

  cv::Size grid_;
  std::vector<Cell> cells_;
  std::vector<Answer> answers_;
  std::vector<float> gains_;
  std::vector<int> columns_;  ///< the column of cells that each pixel of a row belongs to
};

}  // namespace marey::detect::background
