// An image's aim relative to a scene, from all of its pixels: for images in which too few corners stand, because they are
// small and dull, or cars and people fill much of them. Each image is brought to its local contrast, so that a kerb counts as
// much as a white car, on a few sizes. On the smallest every shift is tried, and the best few are followed through the larger ones
// (Gauss-Newton, Geman & McClure's weights). What is hidden in either image agrees with nothing and counts little: the shift
// wins with which most of the scene is seen again, and it is trusted if enough is, and plainly more than with any other.
//
// Assumes that more of the scene is seen in one image than moves alike in it. Cost: 10 to 20 ms an image on one core.
#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/source/stabilise/scene_motion.h"

namespace marey::source::stabilise {

/// One image on a few sizes, in local contrast.
class SceneAppearance {
 public:
  struct Level {
    cv::Mat contrast;  ///< CV_32F: about 1 where there is something
    cv::Mat weight;    ///< CV_32F in [0, 1]: 0 where there is nothing
    double scale = 1;  ///< px of the given image in one of these
  };
  struct Found {
    SceneMotion motion;
    double alike = 0;  ///< share of the scene that is seen again, about 0.25 by chance
  };

  SceneAppearance() = default;
  /// Of a CV_8UC1 image.
  explicit SceneAppearance(const cv::Mat& image);

  bool empty() const { return levels_.empty(); }
  /// Whether there is enough in it to hold on to.
  bool can_be_found() const;

  /// The aim of `now`, of the same size, relative to this, if that can be reported: with which more is alike than with any other
  /// motion, by a share of `plainly`. Not further off than `farthest` px.
  std::optional<Found> find(const SceneAppearance& now, const PinholeView& view, double farthest, double plainly = 0.06) const;

 private:
  /// From `motion` on through the levels `first` to before `end`.
  Found tracked(const SceneAppearance& now, SceneMotion motion, const PinholeView& view, std::size_t first, std::size_t end) const;

  std::vector<Level> levels_;  // the smallest first
};

}  // namespace marey::source::stabilise
