#pragma once

#include <Eigen/Geometry>

#include "marey/geometry/vector.h"

namespace marey::geometry {

/// A rigid motion of space, named `target_from_source`: target = rotation · source + translation. Lengths in m.
struct Rigid3 {
  Matrix<3> rotation = Matrix<3>::Identity();  ///< orthonormal, determinant 1
  Vector<3> translation = Vector<3>::Zero();

  Vector<3> operator*(const Vector<3>& source) const { return rotation * source + translation; }
  Rigid3 operator*(const Rigid3& before) const { return {rotation * before.rotation, *this * before.translation}; }
  Rigid3 inverse() const { return {rotation.transpose(), -(rotation.transpose() * translation)}; }
};

/// The rotation by `angle_axis`' length, in rad, about its direction (Rodrigues' vector, as OpenCV writes it).
Matrix<3> rotation_from(const Vector<3>& angle_axis);

/// The inverse: Rodrigues' vector of a rotation, its length in [0, π].
Vector<3> angle_axis_of(const Matrix<3>& rotation);

}  // namespace marey::geometry
