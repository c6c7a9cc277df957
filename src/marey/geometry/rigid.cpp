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

}  // namespace marey::geometry
