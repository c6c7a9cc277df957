#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/core/geometry.h"
#include "marey/geometry/pitch_elements.h"

namespace marey::format {

/// The elements of the pitch that are labelled in one image.
struct LabelledImage {
  std::string name;  ///< the file's, without its ending, or the key of a file of many
  std::vector<geometry::LabelledElement> elements;
};

/// Reads labels as SoccerNet's camera calibration keeps them: JSON, an object from an element's name to its points, {"x", "y"} as
/// shares of the image; or an object of such objects, an image each. `size`, px: share 1 is the last pixel's centre. Labels that
/// name nothing ("Line unknown", "Goal unknown") and such without points are omitted. Throws Error, with the image and the
/// element, where the file is not one of these.
std::vector<LabelledImage> read_pitch_labels(const std::string& path, cv::Size size);

/// The same from text; `name` is what messages call it.
std::vector<LabelledImage> parse_pitch_labels(std::string_view text, const std::string& name, cv::Size size);

}  // namespace marey::format
