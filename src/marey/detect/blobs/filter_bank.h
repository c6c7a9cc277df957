// What BraMBLe sees of an image: at each point of a grid the responses of a Gaussian and of a Mexican hat (the Gaussian's negated
// Laplacian) to Y, Cb and Cr, six numbers.
//
// Source: Isard, MacCormick, "BraMBLe: A Bayesian Multiple-Blob Tracker", ICCV 2001, from memory: neither that paper nor a copy was
// at hand, only what Queiroz et al. (OpenMoCap) say of it. Remembered: the two kinds of filter, one scale, the three channels, a
// grid of some five pixels. Ours: the Mexican hat as a difference of two Gaussians whose widths are as 1 to 1.6 (Marr, Hildreth
// 1980), and chroma filtered at the half size in which video has it.
// Cost: two blurs of each plane.
#pragma once

#include <opencv2/core.hpp>

#include "marey/core/image.h"

namespace marey::detect::blobs {

inline constexpr int kResponses = 6;  ///< Y, Cb, Cr blurred; then Y, Cb, Cr under the Mexican hat

using Response = cv::Vec<float, kResponses>;

/// The grid of an image of this size: its first point is at ((step − 1) / 2, (step − 1) / 2) px, neighbours are `step` px apart.
cv::Size grid_size(cv::Size image, int step);

/// CV_32FC(6), a response a point of the grid, in grey levels of an image of full range. A grey image has no chroma: 128. `step`
/// ≥ 1; the Gaussian's standard deviation is half of it.
cv::Mat filter_responses(const Image& image, int step);

}  // namespace marey::detect::blobs
