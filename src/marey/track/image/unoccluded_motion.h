#pragma once

#include <cmath>
#include <optional>

#include "marey/core/geometry.h"
#include "marey/core/time.h"

namespace marey::track::image {

/// How a target moved in the image while all of it could be seen. A target that goes behind something seems to slow down, for the
/// part that is left of it shrinks towards its edge; the filter believes that, and then expects it in the wrong place. This
/// remembers better.
class UnoccludedMotion {
 public:
  /// The target was seen, `height` px tall, where the filter has it; `whole` where the observation shows it alone.
  void see(Timestamp now, double dt, const Vector<2>& position, const Vector<2>& velocity, double height, bool whole) {
    if (!seen_) {
      velocity_ = velocity;
      height_ = height;
    }
    if (seen_ && (!whole || height < kLeastShare * height_)) {
      height_ += (height - height_) * (1 - std::exp(-dt / kSizeMemory));  // one that sits down counts as whole after a while
      return;
    }
    velocity_ += (velocity - velocity_) * (1 - std::exp(-dt / kVelocityMemory));
    height_ += (height - height_) * (1 - std::exp(-dt / kSizeMemory));
    position_ = position;
    seen_ = now;
  }

  /// Where the target is by now if it went on as it did.
  std::optional<Vector<2>> position_at(Timestamp now) const {
    if (!seen_) return std::nullopt;
    return position_ + seconds(now - *seen_) * velocity_;
  }

 private:
  static constexpr double kLeastShare = 0.9;      // of its usual height, to be whole
  static constexpr double kVelocityMemory = 0.5;  // s
  static constexpr double kSizeMemory = 2;        // s

  Vector<2> position_ = Vector<2>::Zero(), velocity_ = Vector<2>::Zero();
  double height_ = 0;
  std::optional<Timestamp> seen_;
};

}  // namespace marey::track::image
