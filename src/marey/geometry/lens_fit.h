#pragma once

#include <functional>
#include <optional>

#include <opencv2/core/types.hpp>

#include "marey/geometry/lens.h"
#include "marey/geometry/vector.h"

namespace marey::geometry {

/// A Brown lens that approximates another lens model.
struct BrownFit {
  BrownLens lens;
  Matrix<3> turn = Matrix<3>::Identity();  ///< lens's frame from the frame of the directions
  double rms_px = 0;                       ///< what remains, 2-D, over the image
};

struct BrownFitOptions {
  int coefficients = 5;  ///< how many of k1 k2 p1 p2 k3 … may differ from 0; at most 8
  bool turn = false;     ///< whether the lens's frame may turn against the directions'
};

/// The Brown lens that sees nearest to `direction`: for pixels on a grid over an image of `size` it says in which direction
/// they face (z ahead, any length; nothing if they see nothing). `start` is a first guess of focal length and principal point.
/// Nothing if fewer than 20 grid points use later frames.
std::optional<BrownFit> fit_brown(const std::function<std::optional<Vector<3>>(const Vector<2>& pixel)>& direction, cv::Size size,
                                  const BrownLens& start, const BrownFitOptions& options = {});

}  // namespace marey::geometry
