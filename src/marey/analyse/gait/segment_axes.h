#pragma once

#include <optional>

#include "marey/core/geometry.h"

namespace marey::analyse::gait {

/// The frame whose axis number `first_axis` is along `first`, and whose third one is perpendicular to both directions. Nothing if
/// they do not span a plane.
inline std::optional<Matrix<3>> axes_from(int first_axis, const Vector<3>& first, int second_axis, const Vector<3>& second) {
  const int third_axis = 3 - first_axis - second_axis;
  const double hand = (second_axis - first_axis + 3) % 3 == 1 ? 1 : -1;
  const Vector<3> a = first.normalized(), c = hand * a.cross(second);
  if (!(first.norm() > 1e-6) || !(c.norm() > 1e-6)) return std::nullopt;
  Matrix<3> axes;
  axes.col(first_axis) = a;
  axes.col(third_axis) = c.normalized();
  axes.col(second_axis) = hand * axes.col(third_axis).cross(a);
  return axes;
}

}  // namespace marey::analyse::gait
