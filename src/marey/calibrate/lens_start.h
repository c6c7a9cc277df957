#pragma once

#include <optional>
#include <span>

#include <opencv2/core/types.hpp>

#include "marey/calibrate/lens_calibration.h"

namespace marey {

/// A lens without distortion of that model, focal lengths and principal point in px.
Lens plain_lens(const std::string& model, double focal, const Vector<2>& principal);

/// A first guess by views alone: the focal length that reprojects them best, the principal point in the picture's middle, no
/// distortion. Nothing where no view gives a pose.
std::optional<Lens> first_lens(const Board& board, cv::Size size, std::span<const LensView> views, const std::string& model);

}  // namespace marey
