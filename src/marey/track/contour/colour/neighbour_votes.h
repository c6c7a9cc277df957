#pragma once

#include <array>

#include <opencv2/core.hpp>

#include "marey/track/contour/colour/colour_patch.h"

namespace marey::track::contour::colour {

/// What the eight neighbours of a cell say of its label: one who lies beyond an edge of the image that the scene does not have says
/// less (Boykov & Jolly, "Interactive graph cuts", 2001; the scene's own edges do not count, as in Sun et al., "Background cut",
/// 2006).
class NeighbourVotes {
 public:
  /// `ground` (CV_32FC3) are the scene's colours, of the patch's size.
  NeighbourVotes(const ColourPatch& patch, const cv::Mat& ground);

  /// The weighted mean of `chance` (CV_32FC1) over each cell and its neighbours, with nothing beyond the patch.
  cv::Mat of(const cv::Mat& chance) const;

 private:
  static constexpr std::array<std::array<int, 2>, 4> kToNeighbour{{{1, 0}, {0, 1}, {1, 1}, {-1, 1}}};
  std::array<cv::Mat, 4> weights_;  ///< CV_32FC1: of the neighbour at the right, below, below right, below left
};

}  // namespace marey::track::contour::colour
