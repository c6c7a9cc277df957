#pragma once

#include "marey/geometry/rigid.h"

namespace marey::simulate {

/// camera_from_world of a camera at `centre` that faces `target`, both in metres, z upwards: its image's rows are level but
/// for `roll`, rad. The two points may not stand one above the other.
inline geometry::Rigid3 looking_at(const geometry::Vector<3>& centre, const geometry::Vector<3>& target, double roll = 0) {
  const geometry::Vector<3> ahead = (target - centre).normalized();
  const geometry::Vector<3> right = ahead.cross(geometry::Vector<3>::UnitZ()).normalized();
  geometry::Rigid3 pose;
  pose.rotation << right.transpose(), ahead.cross(right).transpose(), ahead.transpose();
  if (roll != 0) pose.rotation = geometry::rotation_from({0, 0, roll}) * pose.rotation;
  pose.translation = -(pose.rotation * centre);
  return pose;
}

}  // namespace marey::simulate
