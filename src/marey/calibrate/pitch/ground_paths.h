#pragma once

#include <optional>
#include <vector>

#include "marey/calibrate/pitch/ground_offset.h"

namespace marey::calibrate::pitch {

/// A person's path, smoothed without lag: a parabola through observations within half a second before and after, at even times.
class SmoothPath {
 public:
  static constexpr double kStep_s = 0.1;

  explicit SmoothPath(const GroundPath& path);

  struct State {
    Vector<2> location = Vector<2>::Zero();  ///< m
    Vector<2> velocity = Vector<2>::Zero();  ///< m/s
    Matrix<2> noise = Matrix<2>::Zero();     ///< m², of the smoothed place, apart from what is systematic
  };

  /// Nothing if the person was not seen about that time.
  std::optional<State> at(double time_s) const;

  double begin_s() const { return begin_s_; }
  double end_s() const { return begin_s_ + kStep_s * static_cast<double>(states_.size()); }

 private:
  double begin_s_ = 0;
  std::vector<std::optional<State>> states_;
};

}  // namespace marey::calibrate::pitch
