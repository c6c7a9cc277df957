#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "marey/geometry/bspline.h"
#include "marey/track/contour/colour/colour_patch.h"

namespace marey::track::contour::colour {

/// How well the edge under each control point of a curve is known.
struct VisibleEdge {
  std::vector<double> deviations;  ///< px, across the edge
  std::vector<int> hidden;         ///< control points whose edge is not seen, ascending
};

/// What a patch shows of the edge along a curve that was fitted to it. Where a cell outside the curve is another body's (`blocked`,
/// CV_32FC1 of the patch's size, may be empty), at the border of an image of size `image` (px), along an edge of the scene, and
/// where inside and outside are alike, the edge is not visible, and the deviation is `prior` px; elsewhere it is that of an edge of
/// its contrast.
VisibleEdge visible_edge(const geometry::ClosedSpline& spline, const ColourPatch& patch, const cv::Mat& blocked, cv::Size image,
                         double prior);

/// The control points of a curve that lie at the border of an image of that size (px): the body continues beyond it.
std::vector<int> at_border(const geometry::ClosedSpline& spline, cv::Size image);

}  // namespace marey::track::contour::colour
