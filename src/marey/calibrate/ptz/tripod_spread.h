// What the tripod's own uncertainty does to the headings of its frames and to the places that they see.
//
// A tripod that is off takes the headings along: the paint holds the lines where they are seen, so that a place errs far less than
// pan and tilt do. So every independent error of the tripod is followed through the smoother to each frame's heading, and from
// there to the pixels of the pitch in view.
#pragma once

#include <optional>
#include <vector>

#include "marey/calibrate/ptz/smooth_ptz.h"

namespace marey::calibrate::ptz {

struct TripodSpread {
  Matrix<3> heading = Matrix<3>::Zero();  ///< of pan, tilt, ln f themselves
  Matrix<3> location =
      Matrix<3>::Zero();  ///< of pan, tilt, ln f of an exact tripod's camera that errs as much on the pitch in view
};

/// One a frame, zero where `smooth` has none. `covariance` of Tripod::as_numbers.
std::vector<TripodSpread> spread_of_tripod(const std::vector<TurnRecord>& records, const std::vector<std::optional<Aim>>& smooth,
                                           const geometry::Tripod& tripod, const Matrix<geometry::Tripod::numbers>& covariance,
                                           cv::Size size, const SmoothOptions& options);

}  // namespace marey::calibrate::ptz
