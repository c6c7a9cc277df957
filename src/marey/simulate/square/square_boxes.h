#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "marey/core/labelled_box.h"
#include "marey/geometry/camera.h"
#include "marey/simulate/random.h"
#include "marey/simulate/square/square_motion.h"

namespace marey::simulate::square {

/// How a detector errs, from frame to frame independently.
struct SquareDetectorOptions {
  double missed = 0.1;         ///< share of people in view that are not detected
  double size_noise = 0.03;    ///< of each edge, as a share of the box's height and width
  double hidden_missed = 0.1;  ///< share missed of those that nearer boxes cover by more than two thirds
  double false_alarms = 0;     ///< a frame, on average
};

/// A detector's output for one frame of one camera of the people in the square, from left to right. A person cut by the image's
/// border is omitted where less than half of it is within.
std::vector<LabelledBox> square_boxes(std::span<const SquarePerson> people, const SquareMotion& square, const Camera& camera,
                                      std::int32_t frame, const SquareDetectorOptions& options, Random& random);

}  // namespace marey::simulate::square
