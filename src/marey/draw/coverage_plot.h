#pragma once

#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/core/geometry.h"

namespace marey::draw {

/// Where in a camera's image something was measured, and by how much it was off.
struct CoveragePlot {
  std::string title;
  cv::Size size;  ///< px, of the image
  struct Mark {
    Vector<2> pixel = Vector<2>::Zero();
    Vector<2> error = Vector<2>::Zero();  ///< px: seen minus predicted
    bool used = true;
  };
  std::vector<Mark> marks;
};

/// A self-contained SVG: the image's frame in 10 × 8 fields, darker where more marks are, each mark with its error magnified; the
/// title says by how much.
std::string to_svg(const CoveragePlot& plot);

}  // namespace marey::draw
