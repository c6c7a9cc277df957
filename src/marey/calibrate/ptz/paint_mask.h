// What may be paint in one image, whatever camera took it: bright ridges on green, shrunk to a fixed width.
//
// Cost: some 8 ms for 1280 × 720 px.
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/core/image.h"

namespace marey::calibrate::ptz {

inline constexpr int kMaskWidth = 480;  ///< px: images are shrunk to this; numerical: cost

struct PaintMaskOptions {
  int min_ridge = 5, max_ridge = 40;  ///< grey levels above the grass of what may be paint: the lowest level
  double paint_fraction = 0.025;      ///< that no more of the ground exceeds
  int piece = 12;                     ///< shrunk px: pieces that are shorter are grass, not paint
};

struct PaintMask {
  cv::Mat near;                      ///< for each pixel how near the next piece is: 1 on it … 0 beyond 12 px, CV_32F
  cv::Mat about;                     ///< the same, 0 beyond twice as much
  std::vector<Vector<2>> positions;  ///< some of the pieces, shrunk px
  cv::Mat paint;                     ///< 255 where there is some, CV_8UC1
  double ground = 0;                 ///< fraction of the image that is grass
};

PaintMask paint_mask(const Image& image, const PaintMaskOptions& options = {});

/// How many straight pieces of paint, a tenth of the image's width long or longer, lie on different lines.
int distinct_lines(const PaintMask& mask);

}  // namespace marey::calibrate::ptz
