#pragma once

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"

namespace marey::source::stabilise {

/// result(x) = image(from(x)), bilinear, of CV_8UC1 or CV_16UC1, for homographies `picture_from_result` that move every pixel by
/// nearly what they move its neighbour by. What lies outside the image stays as it is in `result`, which has the image's size
/// and type. OpenCV's warps retrieve each pixel anywhere; here neighbours are read together, eight times as fast.
void fast_warp(const cv::Mat& image, const Matrix<3>& picture_from_result, cv::Mat& result);

}  // namespace marey::source::stabilise
