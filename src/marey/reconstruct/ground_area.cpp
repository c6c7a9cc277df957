#include "marey/reconstruct/ground_area.h"

#include <cmath>

#include <Eigen/LU>

#include "marey/core/error.h"

namespace marey::reconstruct {

GroundArea::GroundArea(const std::optional<Matrix<3>>& ground_from_world, const std::optional<geometry::PitchSize>& pitch,
                       double margin)
    : pitch_(pitch), margin_(margin) {
  if (!ground_from_world) return;
  const Matrix<3>& H = *ground_from_world;
  if (H.row(2) != Vector<3>(0, 0, H(2, 2)).transpose() || !(std::abs(H.determinant()) > 1e-12))
    throw Error("the rig's ground_from_world must keep parallels parallel: its last row is [0, 0, 1]");
  ground_from_world_ = H / H(2, 2);
  world_from_ground_ = ground_from_world_.inverse();
}

Vector<2> GroundArea::ground(const Vector<2>& world) const {
  return ground_from_world_.topLeftCorner<2, 2>() * world + ground_from_world_.topRightCorner<2, 1>();
}

Vector<2> GroundArea::ground_velocity(const Vector<2>& velocity) const {
  return ground_from_world_.topLeftCorner<2, 2>() * velocity;
}

Vector<2> GroundArea::world(const Vector<2>& ground) const {
  return world_from_ground_.topLeftCorner<2, 2>() * ground + world_from_ground_.topRightCorner<2, 1>();
}

bool GroundArea::holds(const Vector<2>& world, double slack) const {
  if (!pitch_) return true;
  const Vector<2> at = ground(world);
  const double around = margin_ + slack;
  return at.x() >= -around && at.y() >= -around && at.x() <= pitch_->length + around && at.y() <= pitch_->width + around;
}

}  // namespace marey::reconstruct
