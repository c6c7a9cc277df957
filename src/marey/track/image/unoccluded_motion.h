#pragma once

#include <cmath>
#include <optional>

#include "marey/core/geometry.h"
#include "marey/core/time.h"

namespace marey::track::image {

/// How a target moved in the image while all of it could be seen. A target that goes behind something seems to slow down, for the
/// part that is left of it shrinks towards its edge; the filter trusts that, and then expects it in the wrong place. This
/// remembers better.
class UnoccludedMotion {
 public:
  /// The target was seen, `height` px tall, where the filter has it; `whole` where the observation shows it alone.
  void observe_frame(Timestamp now, double dt, const Vector<2>& position, const Vector<2>& velocity, double height, bool whole) {
    if (!detected_) {
      velocity_ = velocity;
      height_ = height;
    }
    if (detected_ && (!whole || height < kMinFraction * height_)) {
      height_ += (height - height_) * (1 - std::exp(-dt / kSizeMemory));  // one that sits down counts as whole after a while
      return;
    }
    velocity_ += (velocity - velocity_) * (1 - std::exp(-dt / kVelocityMemory));
    height_ += (height - height_) * (1 - std::exp(-dt / kSizeMemory));
    position_ = position;
    detected_ = now;
  }

  /// Where the target is by now if it continued as it did.
  std::optional<Vector<2>> position_at(Timestamp now) const {
    if (!detected_) return std::nullopt;
    return position_ + seconds(now - *detected_) * velocity_;
  }

 private:
  static constexpr double kMinFraction = 0.9;     // of its typical height, to be whole
  static constexpr double kVelocityMemory = 0.5;  // s
  static constexpr double kSizeMemory = 2;        // s

  Vector<2> position_ = Vector<2>::Zero(), velocity_ = Vector<2>::Zero();
  double height_ = 0;
  std::optional<Timestamp> detected_;
};

}  // namespace marey::track::image
