#include "marey/detect/network/image_tensor.h"

namespace marey::detect::network {

cv::Mat image_tensor(const cv::Mat& bgr, ChannelOrder order, const PixelRange& range) {
  CV_Assert(bgr.type() == CV_8UC3 && bgr.isContinuous());
  const int sizes[] = {1, 3, bgr.rows, bgr.cols};
  cv::Mat tensor(4, sizes, CV_32F);
  const std::size_t plane = bgr.total();
  const auto* pixels = bgr.ptr<unsigned char>();
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t channel = order == ChannelOrder::bgr ? c : 2 - c;
    float* values = tensor.ptr<float>() + c * plane;
    for (std::size_t i = 0; i < plane; ++i) values[i] = static_cast<float>(pixels[3 * i + channel]) / range.divisor + range.summand;
  }
  return tensor;
}

}  // namespace marey::detect::network
