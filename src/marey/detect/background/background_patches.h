#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/background/background_plane.h"

namespace marey::detect::background {

/// Finds parts of an image that lie in another light than the scene: the shadows of clouds, a lamp's cone, the sun through a
/// window.
class LightPatches {
 public:
  /// The gain of the light of `luma` over `scene`, CV_32FC1, for the cells of a grid that covers the image evenly; nothing if
  /// it is 1 everywhere. Levels count from `black`.
  std::optional<cv::Mat> measure(const cv::Mat& luma, const ScenePlane& scene, int black);

 private:
  struct Cell {
    int count = 0;
    int frame = 0, scene = 0, frame2 = 0, scene2 = 0, both = 0;      ///< sums of levels over black, their squares and products
    int steps = 0, step_frame2 = 0, step_scene2 = 0, step_both = 0;  ///< the same of the steps between neighbours

    void add_step(int is, int was) {
      ++steps;
      step_frame2 += is * is, step_scene2 += was * was, step_both += is * was;
    }
  };
  enum class Answer { unknown, as_before, other };
  static Answer assess(const Cell& cell, float& gain);
  static bool has_same_steps(const Cell& cell, double gain);
  bool drop_few();
  void sample(const cv::Mat& luma, const ScenePlane& scene, int black);

  cv::Mat lately_;  ///< CV_8UC1: for how many inspections to come a cell counts as one whose light has changed
  cv::Size grid_;
  std::vector<Cell> cells_;
  std::vector<Answer> answers_;
  std::vector<float> gains_;
  std::vector<int> columns_;  ///< the column of cells that each pixel of a row belongs to
};

}  // namespace marey::detect::background
