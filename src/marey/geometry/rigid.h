#pragma once

#include <array>

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

/// The three rows of [R t], as files have them.
std::array<double, 12> rows_of(const Rigid3& pose);
/// The inverse, of 12 numbers.
Rigid3 rigid_from_rows(const double* rows);

}  // namespace marey::geometry
