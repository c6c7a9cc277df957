// A rigid body's path as a uniform cubic B-spline: continuous in acceleration, and each instant rests on four poses alone.
//
// Translation is the typical sum over basis functions; rotation is the cumulative form on the group, q(u) = q0 · exp(B1 log(q0⁻¹
// q1)) · exp(B2 log(q1⁻¹ q2)) · exp(B3 log(q2⁻¹ q3)). Reference: Kim, Kim & Shin, "A general construction scheme for unit
// quaternion curves with simple high order derivatives", SIGGRAPH 1995. Templates on the scalar, so that a solver can differentiate
// them.
#pragma once

#include <array>

#include <ceres/rotation.h>

#include "marey/core/geometry.h"

namespace marey::calibrate::board {

/// A pose as a solver moves it: quaternion w x y z, translation.
template <typename T>
struct SplinePose {
  std::array<T, 4> rotation;
  Eigen::Matrix<T, 3, 1> translation;

  Eigen::Matrix<T, 3, 1> operator*(const Eigen::Matrix<T, 3, 1>& point) const {
    Eigen::Matrix<T, 3, 1> rotated;
    ceres::UnitQuaternionRotatePoint(rotation.data(), point.data(), rotated.data());
    return rotated + translation;
  }
};

/// log(a⁻¹ b), rad.
template <typename T>
std::array<T, 3> rotation_between(const T* a, const T* b) {
  const std::array<T, 4> inverse{a[0], -a[1], -a[2], -a[3]};
  std::array<T, 4> step;
  ceres::QuaternionProduct(inverse.data(), b, step.data());
  std::array<T, 3> turn;
  ceres::QuaternionToAngleAxis(step.data(), turn.data());
  return turn;
}

/// The pose at `u`, 0 to 1 within the segment of four control poses, each 7 numbers (quaternion w x y z, translation).
template <typename T>
SplinePose<T> spline_pose(const T* a, const T* b, const T* c, const T* d, const T& u) {
  const T u2 = u * u, u3 = u2 * u;
  const std::array<T, 3> cumulative{(T(5) + T(3) * u - T(3) * u2 + u3) / T(6), (T(1) + T(3) * u + T(3) * u2 - T(2) * u3) / T(6),
                                    u3 / T(6)};
  const std::array<const T*, 4> controls{a, b, c, d};
  SplinePose<T> pose;
  std::copy_n(a, 4, pose.rotation.begin());
  pose.translation = Eigen::Map<const Eigen::Matrix<T, 3, 1>>(a + 4);
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<T, 3> turn = rotation_between(controls[i], controls[i + 1]);
    for (T& t : turn) t *= cumulative[i];
    std::array<T, 4> step, next;
    ceres::AngleAxisToQuaternion(turn.data(), step.data());
    ceres::QuaternionProduct(pose.rotation.data(), step.data(), next.data());
    pose.rotation = next;
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> here(controls[i] + 4), there(controls[i + 1] + 4);
    pose.translation += cumulative[i] * (there - here);
  }
  return pose;
}

}  // namespace marey::calibrate::board
