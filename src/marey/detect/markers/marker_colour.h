#pragma once

#include <string_view>

#include <opencv2/core.hpp>

#include "marey/core/image.h"

namespace marey::detect::markers {

/// The colour of visible-light markers.
struct MarkerColour {
  double hue_deg = 120;         ///< 0 red, 60 yellow, 120 green, 180 cyan, 240 blue, 300 magenta
  double tolerance_deg = 15;    ///< either way; above 0, at most 60
  double min_saturation = 0.2;  ///< (largest − smallest of red, green, blue) as a share of white; in (0, 1)
};

/// Reads "120±15", "120+-15" or "120" (tolerance 15): degrees. Throws Error if the text is something else or out of range.
MarkerColour parse_marker_colour(std::string_view text);

/// How much of the colour each pixel of the chroma planes holds, CV_8UC1 at their size: 0 where hue or saturation is out of
/// bounds, else 64 at the least saturation and in proportion above. Throws Error if the image is grey.
void colour_heights(const Image& image, const MarkerColour& colour, cv::Mat& heights);

}  // namespace marey::detect::markers
