#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/core/picture.h"

namespace marey::detect::people {

/// In which rows of a picture a standing body begins and ends, px, to a fraction of one.
struct BodyRows {
  double head = 0;   ///< the upper edge of the head
  double sole = 0;   ///< the lower edge of the lower foot
  double stand = 0;  ///< half way between the lower edges of both feet where both are on the ground: between them it stands
};

struct BodyRowsOptions {
  double edge = 0.4;           ///< of the strongest contrast of a head or foot with the ground: there its edge is
  double chroma = 0.25;        ///< weight of a level of chroma, beside luma's 1: it is blurred more
  double least_contrast = 14;  ///< levels; what differs less keeps the mask's edge
  double stride = 0.4;         ///< of the body's height, on the ground: the farthest that one foot is before the other
};

/// Where the body alone in `box` (px, of its silhouette in `mask`, CV_8UC1) ends in `picture`. `steepness`: how many rows a step
/// along the view takes on the ground, as a share of what it takes upright (the sine of the angle at which the camera looks
/// down, far away). Nothing where neither end of the body can be told better than by the mask.
std::optional<BodyRows> find_body_rows(const Picture& picture, const cv::Mat& mask, const Box& box, double steepness,
                                       const BodyRowsOptions& options = {});

}  // namespace marey::detect::people
