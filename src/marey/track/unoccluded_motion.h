#pragma once

#include <cmath>
#include <optional>

#include "marey/core/geometry.h"
#include "marey/core/time.h"

namespace marey::track {

/// How somebody moved while all of him could be seen. Who goes behind something seems to slow down, for the part of him that
/// is left shrinks towards its edge; the filter believes that, and then looks for him in the wrong place. This remembers better.
template <int D>
class UnoccludedMotion {
 public:
  /// He was seen, `height` tall, where the filter says, `sure` where the observation counts.
  void see(Timestamp now, double dt, const Vector<D>& place, const Vector<D>& velocity, double height, bool sure) {
    if (!seen_) {
      velocity_ = velocity;
      height_ = height;
    }
    if (seen_ && (!sure || height < least_share * height_)) {
      height_ += (height - height_) * (1 - std::exp(-dt / size_memory));  // who sits down is whole again after a while
      return;
    }
    velocity_ += (velocity - velocity_) * (1 - std::exp(-dt / velocity_memory));
    height_ += (height - height_) * (1 - std::exp(-dt / size_memory));
    place_ = place;
    seen_ = now;
  }

  /// Where he is by now if he went on as he did.
  std::optional<Vector<D>> place_at(Timestamp now) const {
    if (!seen_) return std::nullopt;
    return place_ + seconds(now - *seen_) * velocity_;
  }

 private:
  static constexpr double least_share = 0.9;      // of his usual height, to be whole
  static constexpr double velocity_memory = 0.5;  // s
  static constexpr double size_memory = 2;        // s

  Vector<D> place_ = Vector<D>::Zero(), velocity_ = Vector<D>::Zero();
  double height_ = 0;
  std::optional<Timestamp> seen_;
};

}  // namespace marey::track
