#pragma once

#include <opencv2/core.hpp>

#include "marey/track/contour/colour/colour_patch.h"

namespace marey::track::contour::colour {

/// How well each cell's colour goes with the ground, as it is or in a shadow: CV_32FC1, a density per level³ times the chance of
/// the cell's state in the foreground mask. `ground` (CV_32FC3) are the ground's colours, of the patch's size.
cv::Mat ground_likelihood(const ColourPatch& patch, const cv::Mat& ground);

/// The chance of a cell's foreground value (0 … 1) if it shows a body.
float mask_chance_on_body(float mask);

}  // namespace marey::track::contour::colour
