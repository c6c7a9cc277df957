#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"

namespace marey::track::contour {

/// A silhouette's polygon (px, clockwise as seen on the screen, along pixel edges) with every piece of it moved to the edge of
/// intensity beside it, if there is a clear one, and most of the distance: the silhouette knows whole pixels, light knows parts of
/// them and is mistaken at times. The result has a point about every pixel. `luma` is CV_8UC1; otherwise, or where the polygon has
/// no length, the polygon is returned as it is.
std::vector<Vector<2>> moved_to_intensity_edges(const std::vector<Vector<2>>& polygon, const cv::Mat& luma);

}  // namespace marey::track::contour
