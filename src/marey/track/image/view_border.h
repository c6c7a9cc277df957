// Where the image ends, read off boxes alone: a detector cuts them off there, so that many end in one line.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

#include "marey/core/geometry.h"

namespace marey::track::image {

/// Takes in boxes, and finds the image's border on those sides where boxes of people in several places ended at one coordinate.
class ViewBorder {
 public:
  void observe_frame(const Box& box) {
    left_.observe_frame(-box.left, box.top);
    top_.observe_frame(-box.top, box.left);
    right_.observe_frame(box.right(), box.top);
    bottom_.observe_frame(box.bottom(), box.left);
  }

  /// px; a side that is not known lies far away. Nothing if none is known.
  std::optional<Box> view() const {
    if (!left_.known() && !top_.known() && !right_.known() && !bottom_.known()) return std::nullopt;
    const double left = -left_.border(), top = -top_.border();
    return Box{left, top, right_.border() - left, bottom_.border() - top};
  }

 private:
  // Unswept.
  static constexpr double kOneLine = 1.5;  // px within which ends lie in one line
  static constexpr double kPosition = 64;  // px along the border that count as one place
  static constexpr int kPositions = 3;     // in which boxes must end
  static constexpr double kFar = 1e7;      // px

  class Side {
   public:
    void observe_frame(double end, double along) {
      if (end > farthest_ + kOneLine) locations_ = 0;
      if (end > farthest_) farthest_ = end;
      if (end < farthest_ - kOneLine) return;
      locations_ |= std::uint64_t{1} << (static_cast<std::int64_t>(std::floor(along / kPosition)) & 63);
    }
    bool known() const { return std::popcount(locations_) >= kPositions; }
    double border() const { return known() ? farthest_ : kFar; }

   private:
    double farthest_ = -kFar;
    std::uint64_t locations_ = 0;  // bits: in which of them boxes ended at `farthest_`
  };

  Side left_, top_, right_, bottom_;
};

}  // namespace marey::track::image
