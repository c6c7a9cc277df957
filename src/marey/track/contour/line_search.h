#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/core/outline.h"
#include "marey/geometry/bspline.h"
#include "marey/track/contour/colour/footprint.h"

namespace marey::track::contour {

/// What lines are searched in.
struct LineScene {
  cv::Mat mask;                                      ///< CV_8UC1, 255 where the foreground is
  std::span<const colour::Footprint* const> others;  ///< targets that may own pixels near this one
};

/// Faces along one line for the place where the foreground ends, going outward. Fills in the edge found, where, and how surely;
/// `deviation` is how well the place is predicted, px. `line.foot`, `normal` and `reach` are given.
void search_line(MeasurementLine& line, const LineScene& scene, double deviation);

}  // namespace marey::track::contour
