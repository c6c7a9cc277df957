#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/mask.h"
#include "marey/detect/markers/marker_colour.h"

namespace marey::detect::markers {

struct MarkerOptions {
  static constexpr std::string_view name = "markers";

  bool dark = false;                   ///< markers are darker than what is around them; no part where `colour` is given
  std::optional<MarkerColour> colour;  ///< markers of this colour, however bright
  std::optional<double> threshold;     ///< grey level that a marker's pixels pass; nothing: from the image's noise
  double widest = 0;            ///< px: markers are no wider, and what they stand out from is what lies close by; 0: not used
  double min_area = 2;          ///< px² that pass the threshold
  double max_area = 10000;      ///< px²
  double min_roundness = 0.25;  ///< area over that of the circle as long as the blob: 1 a disc, b/a an ellipse
  int max_markers = 5000;       ///< a frame; beyond, those where the tracker expects one stay, then the largest
  cv::Mat mask;                 ///< CV_8UC1 of the image's size, what is not 0 is omitted; empty for none
  std::vector<Mask> masked;     ///< px: parts of the image that are omitted too, as far as they lie in it
  double auto_mask_s = 0;       ///< learn for this long what is bright and does not move, then leave it out; 0: never

  /// Whether what a marker must stand out by is learned from the images.
  bool automatic() const { return !colour && !threshold; }
};

}  // namespace marey::detect::markers
