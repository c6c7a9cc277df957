#pragma once

#include <array>
#include <optional>

#include <opencv2/core.hpp>

#include "marey/core/image.h"

namespace marey::track::contour::colour {

/// How far an image's chroma lies to the right of its luma: analog filters, broadcast chains and wrong sites of chroma samples
/// displace it by 1 to 2 px, a fringe of colour on one side of everything.
class ChromaShift {
 public:
  /// Compares where luma and chroma change along the rows of the foreground (CV_8UC1, of the image's size), every fourth row of
  /// chroma in a frame. Grey images and other sizes are ignored.
  void observe(const Image& image, const cv::Mat& foreground);

  /// px of luma, in [−4, 4]; 0 without enough foreground, or where nothing decides.
  double px() const;
  /// px of luma, standard deviation: how far the colour of an edge is smeared beyond what its resolution does; 0 where `px` has
  /// nothing to say.
  double smear() const;

 private:
  static constexpr int kReach = 3;  // of chroma's pixels to either side

  void observe_row(const Image& image, const cv::Mat& foreground, int row);

  struct Peak {
    double at = 0, width = 0;  ///< of chroma's pixels
  };
  std::optional<Peak> peak() const;

  int next_ = 0;
  double pixels_ = 0;                              // pixels of foreground, of late
  std::array<double, 2 * kReach + 1> together_{};  // changes of luma times those of chroma so far to the right, of late
};

}  // namespace marey::track::contour::colour
