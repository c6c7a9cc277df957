#pragma once

#include <opencv2/core.hpp>

namespace marey::detect::background {

/// The difference of two images, smoothed over 3 × 3 pixels and not divided by nine: integers, of which median and deviation come
/// from a count of each value. Costs three passes of 16 bit over the image. At the border, pixels are mirrored about the
/// outermost, as by cv::blur.
class DifferenceSums {
 public:
  /// What the differences have in common, levels.
  struct Noise {
    double shade = 0;      ///< their median
    double deviation = 0;  ///< the median of their distances from it
  };

  /// `now` - `scene`: CV_8UC1, of one size, not empty.
  DifferenceSums(const cv::Mat& scene, const cv::Mat& now);

  /// Of all pixels but those in `body`, which is within the image. All 0 where there are no others.
  Noise noise_outside(const cv::Rect& body) const;

  /// Sets `mask` (CV_8UC1, of the images' size) to 255 where the difference is further than `least` levels from `shade`; else
  /// leaves it.
  void mark(double shade, double minimum, cv::Mat& mask) const;

 private:
  cv::Mat sums_;  ///< CV_16SC1: nine differences
};

}  // namespace marey::detect::background
