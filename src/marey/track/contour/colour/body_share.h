#pragma once

#include <opencv2/core.hpp>

#include "marey/track/contour/colour/colour_patch.h"

namespace marey::track::contour::colour {

/// The colour of the ground about an object, from the pixels next to it, at each cell: CV_32FC3. `taken` (CV_32FC1) is not zero
/// where anything is that is not ground. `height` of the thing in px.
cv::Mat ground_next_to(const ColourPatch& patch, const cv::Mat& taken, double height);

/// What share of each cell a body covers, 0 … 1, where no other person is near: CV_32FC1. `own` (CV_32FC1, 0 or 1) are the cells of
/// its silhouette, which runs on the halo of sharpening and on the colour that a codec smears round it; `height` in px.
cv::Mat body_fraction(const ColourPatch& patch, const cv::Mat& own, double height);

}  // namespace marey::track::contour::colour
