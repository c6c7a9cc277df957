#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"

namespace marey::calibrate::board {

/// The place where four squares of a board meet, refined from `start`, px. `grey` is CV_8UC1 and `spacing` the distance to the
/// nearest other corner: what lies farther away than a share of it is not inspected. Nothing if there is no corner within reach.
std::optional<Vector<2>> refine_corner(const cv::Mat& grey, const Vector<2>& start, double spacing);

/// How alike opposite points round `pixel` are, up to `radius` px away: 1 where four squares meet, near 0 where what hides the
/// board ends, negative on an edge. 0 where there is no contrast or the image ends.
double opposite_likeness(const cv::Mat& grey, const Vector<2>& pixel, double radius);

}  // namespace marey::calibrate::board
