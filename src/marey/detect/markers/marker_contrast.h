#pragma once

#include <optional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/markers/marker_runs.h"

namespace marey::detect::markers {

/// What a blob stands out by from the pixels round it, whatever the threshold was that it passed.
struct MarkerContrast {
  double around = 0;  ///< grey levels: the middle of the pixels 3 px outside the blob's box
  /// Grey levels by which the blob's brightest pixel stands over the lowest within 3 px of its box, in nine of ten directions: an
  /// edge or a corner of something wide does not fall off to all sides, two markers with a valley between them do.
  double height = 0;
  double halo =
      0;  ///< of larger blobs: what is around it over what is 9 px further out, in heights; a lamp's light falls off slowly
};

/// `otherwise` is what is around where all of that lies outside the image. `dark` turns the heights round.
MarkerContrast contrast_of(const cv::Mat& luma, const MarkerBlob& blob, bool dark, double otherwise);

/// Area over that of the circle with the same largest second moment (a disc of radius R has R²/4).
double roundness_of(const MarkerBlob& blob);

/// How much a blob counts where it is asked what markers are like: the brighter and the larger the more, up to a size beyond which
/// it is no better a marker. Specks are many, and count little.
double report_of(double contrast, double area);

/// The contrast that clutter does not reach: what stands out by at most half of what markers do is taken for the beginning of an
/// exponential tail, in whose continuation less than one in twenty images has anything. At most half of `typical`.
double above_clutter(std::span<const double> contrasts, double typical);

}  // namespace marey::detect::markers
