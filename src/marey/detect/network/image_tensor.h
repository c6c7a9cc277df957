#pragma once

#include <opencv2/core.hpp>

namespace marey::detect::network {

/// A network's input values: pixel / `divisor` + `summand`.
struct PixelRange {
  float divisor = 255, summand = 0;  ///< [0, 1]
};
enum class ChannelOrder { rgb, bgr };

/// 1 × 3 × rows × columns of floats, of a continuous image of 8-bit pixels, blue first (a crop).
cv::Mat image_tensor(const cv::Mat& bgr, ChannelOrder order, const PixelRange& range);

}  // namespace marey::detect::network
