#pragma once

#include <memory>

#include <opencv2/core.hpp>

#include "marey/core/image.h"

struct AVFrame;
struct SwsContext;

namespace marey::source {

/// Makes Images of what FFmpeg decodes. 4:2:0 and grey are taken as they are, without a copy for 4:2:0; any other storage
/// (RGB, 4:2:2, 10 bits …) is brought to 4:2:0, and grey deeper than 8 bits to 16.
class ImageConverter {
 public:
  ImageConverter();
  ~ImageConverter();

  /// Turns images clockwise by 0, 90, 180 or 270 degrees.
  void turn_by(int degrees) { turn_ = degrees; }

  /// `size` is the decoder's, before turning; an image of another size is scaled to it. Empty if it cannot be converted.
  Image operator()(const AVFrame& decoded, cv::Size size);

 private:
  struct Scaler;
  Image converted(const AVFrame& decoded, cv::Size size, bool full_range);
  Image rotated(const Image& image) const;

  std::unique_ptr<Scaler> scaler_;
  int turn_ = 0;
};

}  // namespace marey::source
