#pragma once

#include <optional>
#include <span>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/core/image.h"
#include "marey/detect/silhouette.h"

namespace marey::detect::people {

/// A part of a frame, and of the empty scene behind it.
struct ObservedPart {
  Image frame, scene;  ///< of one size, both with colour or both grey
  cv::Point corner;    ///< px: of both, in the whole image
};

/// Rows, of a box that holds a body: px, fractions too.
struct BodyEnds {
  std::optional<double> top;     ///< as of Box::top
  std::optional<double> bottom;  ///< as of Box::bottom()
};

/// The rows that must be seen to find where the body in `box` ends, clipped to an image of this size, its corner on even pixels.
cv::Rect part_for_ends(const Box& box, cv::Size image);

/// Where the body ends whose silhouette is `runs` (in order) within `box`: where its contrast with the empty scene falls below half
/// of what it is inside. A silhouette runs on the halo of sharpening, smeared colour and the weak shadow under the shoes; the
/// contrast of all those is less than half. Nothing if the body does not differ enough from the scene.
BodyEnds find_ends(std::span<const PixelRun> runs, const Box& box, const ObservedPart& detected);

/// How much too far silhouettes of one camera reach, learned from those that could be measured: running medians.
class SilhouetteExcess {
 public:
  /// `ends` were found for a silhouette that spans `box`.
  void learn(const Box& box, const BodyEnds& ends);
  /// The same box, of the body alone: as measured, but no further from what is typical than 1.5 px; as normal where nothing was
  /// measured.
  Box without(const Box& box, const BodyEnds& ends) const;

  double above() const { return above_; }  ///< px, usually
  double below() const { return below_; }

 private:
  double above_ = 0, below_ = 0;
  int observed_above_ = 0, observed_below_ = 0;
};

}  // namespace marey::detect::people
