#pragma once

#include <opencv2/core/mat.hpp>

#include "marey/core/geometry.h"
#include "marey/core/image.h"

namespace marey::detect::keypoints {

/// A square part of an image, turned so that the person in it stands upright. A landmark network sees it as a crop of `kCrop` px,
/// whose coordinates count from its upper left edge: the middle is at kCrop / 2.
struct PersonRegion {
  static constexpr int kCrop = 256;  // px

  Vector<2> centre = Vector<2>::Zero();  ///< px of the image
  double side = 0;                       ///< px of the image
  double angle = 0;                      ///< rad, clockwise on the screen, from the image's up to the person's

  double scale() const { return side / kCrop; }  ///< px of the image for one of the crop's
  /// The linear part of the map from the crop to the image.
  Matrix<2> turn() const;
  Vector<2> in_image(const Vector<2>& in_crop) const;
};

/// Round a person who is taken to stand upright, or as far as the box shows.
PersonRegion region_of(const Box& box);

/// Round a person whose hips' middle is at `hips`, with `rim` at the circle that holds the whole body, in the direction of the
/// head.
PersonRegion region_of(const Vector<2>& hips, const Vector<2>& rim);

/// What a landmark network is shown: CV_8UC3 like `bgr`, kCrop × kCrop. Beyond the image's border its last pixels continue.
cv::Mat crop_of(const cv::Mat& bgr, const PersonRegion& region);
/// The same of an image as cameras deliver it: only the part that is needed is converted to colours, after it was halved as often
/// as the crop permits.
cv::Mat crop_of(const Image& image, const PersonRegion& region);

}  // namespace marey::detect::keypoints
