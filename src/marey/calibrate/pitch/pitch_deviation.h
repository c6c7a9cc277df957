#pragma once

#include <cstddef>
#include <optional>

#include "marey/calibrate/pitch/pitch_fit.h"

namespace marey::calibrate::pitch {

/// Covariance, m², of the place on the ground that a pixel of camera `index` shows, for what calibration leaves unknown; `ground`
/// in the world. Nothing if the camera does not see it.
std::optional<Matrix<2>> position_covariance(const PitchFit& fit, std::size_t index, const Vector<2>& ground);

}  // namespace marey::calibrate::pitch
