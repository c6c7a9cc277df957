#include "marey/solve/skeleton/inverse_dynamics.h"

#include <cassert>
#include <optional>

#include <Eigen/Geometry>

namespace marey::solve::skeleton {
namespace {

/// A frame's place and motion in the world.
struct MovingFrame {
  Matrix<3> rotation = Matrix<3>::Identity();
  Vector<3> origin = Vector<3>::Zero(), velocity = Vector<3>::Zero(), acceleration = Vector<3>::Zero();
  Vector<3> angular_velocity = Vector<3>::Zero(), angular_acceleration = Vector<3>::Zero();  // rad/s, rad/s²

  /// The acceleration of a point that the frame carries, `from_origin` in the world.
  Vector<3> acceleration_at(const Vector<3>& from_origin) const {
    return acceleration + angular_acceleration.cross(from_origin) + angular_velocity.cross(angular_velocity.cross(from_origin));
  }
  /// Its origin goes along `shift` (world), which grows with `rate` and `change` (world, seen from the frame).
  void shift_origin(const Vector<3>& shift, const Vector<3>& rate = Vector<3>::Zero(),
                    const Vector<3>& change = Vector<3>::Zero()) {
    acceleration = acceleration_at(shift) + 2 * angular_velocity.cross(rate) + change;
    velocity += angular_velocity.cross(shift) + rate;
    origin += shift;
  }
  void move(const Rigid3& fixed) {
    shift_origin(rotation * fixed.translation);
    rotation = rotation * fixed.rotation;
  }
};

/// A joint's elementary turn or shift, in the world.
struct ElementaryAxis {
  std::optional<int> coordinate;
  bool is_rotation = true;
  double slope = 0;  // of its amount, by the coordinate
  Vector<3> direction, point;
};

void move_along(const JointAxis& axis, const CoordinateMotion& motion, MovingFrame& frame, std::vector<ElementaryAxis>& axes) {
  double amount = axis.amount.value(0), rate = 0, change = 0, slope = 0;
  if (axis.coordinate) {
    const auto c = static_cast<std::size_t>(*axis.coordinate);
    const double q = motion.value[c], speed = motion.speed[c];
    slope = axis.amount.slope(q);
    amount = axis.amount.value(q);
    rate = slope * speed;
    change = slope * motion.acceleration[c] + axis.amount.curvature(q) * speed * speed;
  }
  const Vector<3> direction = frame.rotation * axis.axis;
  axes.push_back({axis.coordinate, axis.is_rotation, slope, direction, frame.origin});
  if (!axis.is_rotation) {
    frame.shift_origin(direction * amount, direction * rate, direction * change);
    return;
  }
  frame.rotation = frame.rotation * Eigen::AngleAxisd(amount, axis.axis).toRotationMatrix();
  frame.angular_acceleration += direction * change + frame.angular_velocity.cross(direction * rate);
  frame.angular_velocity += direction * rate;
}

/// Force and moment about the world's origin.
struct Wrench {
  Vector<3> force = Vector<3>::Zero(), moment = Vector<3>::Zero();
  void add(const Vector<3>& other, const Vector<3>& point) {
    force += other;
    moment += point.cross(other);
  }
};

/// What moves a segment as it moves, gravity omitted.
Wrench moving_wrench(const MovingFrame& frame, const SegmentMass& mass, double gravity) {
  const Vector<3> centre = frame.rotation * mass.centre;
  const Matrix<3> inertia = frame.rotation * mass.inertia * frame.rotation.transpose();
  Wrench wrench;
  wrench.add(mass.mass_kg * (frame.acceleration_at(centre) + Vector<3>(0, 0, gravity)), frame.origin + centre);
  wrench.moment += inertia * frame.angular_acceleration + frame.angular_velocity.cross(inertia * frame.angular_velocity);
  return wrench;
}

}  // namespace

std::vector<double> inverse_dynamics(const Skeleton& skeleton, std::span<const SegmentMass> masses, const CoordinateMotion& motion,
                                     std::span<const SegmentLoad> loads, double gravity) {
  const std::size_t segments = skeleton.segments.size();
  assert(masses.size() == segments && motion.value.size() == skeleton.coordinates.size());
  std::vector<MovingFrame> frames(segments);
  std::vector<std::vector<ElementaryAxis>> axes(segments);
  std::vector<Wrench> wrenches(segments);
  for (std::size_t s = 0; s < segments; ++s) {
    const Segment& segment = skeleton.segments[s];
    MovingFrame frame = segment.parent ? frames[static_cast<std::size_t>(*segment.parent)] : MovingFrame();
    frame.move(segment.joint.parent_from_joint);
    for (const JointAxis& axis : segment.joint.axes) move_along(axis, motion, frame, axes[s]);
    frame.move(segment.joint.joint_from_segment);
    frames[s] = frame;
    wrenches[s] = moving_wrench(frame, masses[s], gravity);
  }
  for (const SegmentLoad& load : loads) {
    Wrench& wrench = wrenches[static_cast<std::size_t>(load.segment)];
    wrench.add(-load.force, load.point);
    wrench.moment -= load.moment;
  }
  std::vector<double> forces(skeleton.coordinates.size(), 0.0);
  for (std::size_t s = segments; s-- > 0;) {
    const Wrench& wrench = wrenches[s];
    for (const ElementaryAxis& axis : axes[s]) {
      if (!axis.coordinate) continue;
      const double along =
          axis.is_rotation ? axis.direction.dot(wrench.moment - axis.point.cross(wrench.force)) : axis.direction.dot(wrench.force);
      forces[static_cast<std::size_t>(*axis.coordinate)] += axis.slope * along;
    }
    if (!skeleton.segments[s].parent) continue;
    Wrench& parent = wrenches[static_cast<std::size_t>(*skeleton.segments[s].parent)];
    parent.force += wrench.force;
    parent.moment += wrench.moment;
  }
  return forces;
}

void couple(const Skeleton& skeleton, CoordinateMotion& motion) {
  for (std::size_t c = 0; c < skeleton.coordinates.size(); ++c) {
    const auto& coupling = skeleton.coordinates[c].coupling;
    if (!coupling) continue;
    const auto to = static_cast<std::size_t>(coupling->to);
    const double q = motion.value[to], slope = coupling->function.slope(q);
    motion.value[c] = coupling->function.value(q);
    motion.speed[c] = slope * motion.speed[to];
    motion.acceleration[c] =
        slope * motion.acceleration[to] + coupling->function.curvature(q) * motion.speed[to] * motion.speed[to];
  }
}

}  // namespace marey::solve::skeleton
