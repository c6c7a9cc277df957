// How likely it is that a box near where a person is expected is another person's: people in the room that they have.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "marey/track/image/camera_motion.h"

namespace marey::track::image {

/// Learns from every frame's boxes how many there are in an area of one person's height squared.
class Clutter {
 public:
  void observe_frame(std::span<const Sighting> boxes) {
    ++frames_;
    for (const Sighting& box : boxes) {
      covered_ += box.size * box.size;
      low_ = low_.cwiseMin(box.location);
      high_ = high_.cwiseMax(box.location);
    }
  }

  /// What a match may cost more than in a crowd, in twice the logarithm of a likelihood.
  double room() const {
    if (covered_ <= 0) return 0;
    const double area = std::max(1.0, (high_ - low_).prod());
    return kFraction * 2 * std::log(std::max(1.0, kCrowded / (covered_ / static_cast<double>(frames_) / area)));
  }

 private:
  static constexpr double kCrowded = 0.67;  // boxes in a height squared: a street that people fill (TUD)
  static constexpr double kFraction =
      0.3;  // of the log-likelihood ratio: a detection near a person is rarely a new one (bench/tuning.md)

  std::int64_t frames_ = 0;
  double covered_ = 0;                                                           // px²: heights squared, of all boxes
  Vector<2> low_ = Vector<2>::Constant(1e9), high_ = Vector<2>::Constant(-1e9);  // of the places of boxes
};

}  // namespace marey::track::image
