#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"

namespace marey::evaluate {

/// A true silhouette on a lattice of `samples` × `samples` points per pixel. Lattice column i lies at x = (i + ½) / samples − ½ px.
struct SilhouetteMask {
  cv::Mat mask;      ///< CV_8UC1, not zero where the silhouette is
  cv::Point corner;  ///< the lattice place of mask's first point
  int samples = 1;
};

/// How a curve and a silhouette overlap, px².
struct OutlineOverlap {
  double shared = 0;      ///< inside both
  double outline = 0;     ///< inside the curve
  double silhouette = 0;  ///< of the silhouette

  /// Intersection over union, in [0, 1]; 0 where both are empty.
  double iou() const;
};

/// Lays a closed polygon (px; inside is where a ray crosses it an odd number of times) over a silhouette, lattice point by lattice
/// point. With `image`, only what lies in an image of that size counts. Cost: the lattice points of both boxes.
OutlineOverlap overlap(std::span<const Vector<2>> polygon, const SilhouetteMask& truth, const cv::Size* image = nullptr);

/// The same of the rest of the polygon where `nearer` curves do not cover it: what is visible of it.
OutlineOverlap visible_overlap(std::span<const Vector<2>> polygon, std::span<const std::vector<Vector<2>>> nearer,
                               const SilhouetteMask& truth, const cv::Size& image);

}  // namespace marey::evaluate
