#pragma once

#include <span>

#include <opencv2/core.hpp>

#include "marey/detect/background/background_shadow.h"
#include "marey/detect/silhouette.h"

namespace marey::detect::background {

/// Writes into `covered` what of `mask` (both CV_8UC1, 255 or 0, of one size; zero outside `runs`, which are in order) is left
/// when pixels at the rim are taken away of which less than half is covered.
void trim_fringe(const cv::Mat& mask, std::span<const PixelRun> runs, const FramePlanes& frame, const SceneView& scene,
                 cv::Mat& covered);

}  // namespace marey::detect::background
