#include "marey/geometry/rigid.h"

namespace marey::geometry {

Matrix<3> rotation_from(const Vector<3>& angle_axis) {
  const double angle = angle_axis.norm();
  if (angle < 1e-300) return Matrix<3>::Identity();
  return Eigen::AngleAxisd(angle, angle_axis / angle).toRotationMatrix();
}

Vector<3> angle_axis_of(const Matrix<3>& rotation) {
  const Eigen::AngleAxisd angle_axis(rotation);
  return angle_axis.angle() * angle_axis.axis();
}

std::array<double, 12> rows_of(const Rigid3& pose) {
  std::array<double, 12> rows{};
  auto to = rows.begin();
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) *to++ = pose.rotation(i, k);
    *to++ = pose.translation[i];
  }
  return rows;
}

Rigid3 rigid_from_rows(const double* rows) {
  Rigid3 pose;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) pose.rotation(i, k) = *rows++;
    pose.translation[i] = *rows++;
  }
  return pose;
}

}  // namespace marey::geometry
