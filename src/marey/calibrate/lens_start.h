#pragma once

#include <optional>
#include <span>

#include <opencv2/core/types.hpp>

#include "marey/calibrate/lens_calibration.h"

namespace marey::calibrate {

/// A lens without distortion of that model, focal lengths and principal point in px.
geometry::Lens plain_lens(const std::string& model, double focal, const Vector<2>& principal);

/// A first guess by views alone: the focal length that reprojects them best, the principal point in the image's middle, no
/// distortion. Nothing if no view gives a pose.
std::optional<geometry::Lens> first_lens(const board::Board& board, cv::Size size, std::span<const LensView> views,
                                         const std::string& model);

}  // namespace marey::calibrate
