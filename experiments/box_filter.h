#pragma once

#include <optional>

#include <Eigen/Core>

#include "marey/core/geometry.h"

namespace marey::experiments {

struct BoxFilterOptions {
  double position_noise = 1;     ///< px, of a measured centre and of a measured edge
  double initial_velocity = 5;   ///< px a frame, standard deviation before anything is known
  double velocity_noise = 0.5;   ///< px a frame, a frame
  double size_noise = 0.3;       ///< px a frame: drift of the edges against the centre
  double largest_change = 0.25;  ///< of width or height: a box that differs by more is not trusted (Xu et al.: frozen)
};

/// The box filter of Xu, Orwell, Lowey & Thirde, "Architecture and algorithms for tracking football players with multiple cameras"
/// (2005): state r_c c_c v_rc v_cc Δr₁ Δc₁ Δr₂ Δc₂, measurement r_c c_c r₁ c₁ r₂ c₂. Rows and columns in px, velocities in px a
/// frame. While the measured box jumps in size, nothing of it is trusted and the state is predicted. For comparison.
class BoxFilter {
 public:
  BoxFilter(const BoxFilterOptions& options, const Box& first, const Vector<2>& centre);

  /// The next frame: the box and centre of area measured for this target, or nothing.
  void step(const std::optional<Box>& box, const std::optional<Vector<2>>& centre);

  Box box() const;
  Vector<2> centre() const;
  Vector<2> velocity() const;              ///< px a frame
  bool frozen() const { return frozen_; }  ///< the last measurement was missing or not trusted

 private:
  Eigen::Matrix<double, 8, 1> x_;
  Eigen::Matrix<double, 8, 8> P_;
  BoxFilterOptions options_;
  bool frozen_ = false;
};

}  // namespace marey::experiments
