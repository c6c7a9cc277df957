#pragma once

#include <opencv2/core.hpp>

#include "marey/track/contour/colour/colour_patch.h"

namespace marey::track::contour::colour {

/// Puts the edge of a body where its colours end: in the cells along the 0.5 level of `share` (CV_32FC1, 0 … 1: whether a cell
/// shows the body), the fraction of body by the cell's colour between the body's colour inside and the ground's, where these differ
/// enough to decide. Cells where `blocked` (CV_32FC1, may be empty) exceeds one tenth keep their share: another body is there.
/// `ground` is CV_32FC3; `height` of the body in px. Cost: two box filters.
cv::Mat matted_edge(const ColourPatch& patch, const cv::Mat& fraction, const cv::Mat& blocked, const cv::Mat& ground,
                    double height);

}  // namespace marey::track::contour::colour
