#include "marey/solve/skeleton/articulation.h"

#include <array>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace marey::solve::skeleton {

Articulation::Articulation(const Skeleton& skeleton)
    : skeleton_(&skeleton),
      dof_of_coordinate_(skeleton.coordinates.size(), -1),
      ball_of_segment_(skeleton.segments.size(), -1),
      world_from_(skeleton.segments.size()) {
  // A coordinate that moves more than one joint stays one: its joint is not a ball.
  for (std::size_t s = 0; s < skeleton.segments.size(); ++s) find_ball(static_cast<int>(s), skeleton.segments[s].joint);
  std::vector<bool> of_ball(skeleton.coordinates.size(), false);
  for (const Ball& ball : balls_) {
    for (const int c : ball.coordinates) of_ball[static_cast<std::size_t>(c)] = true;
  }
  for (std::size_t c = 0; c < skeleton.coordinates.size(); ++c) {
    if (!skeleton.coordinates[c].free() || of_ball[c]) continue;
    dof_of_coordinate_[c] = dofs();
    dofs_.push_back({static_cast<int>(c), -1, 0, skeleton.coordinates[c].is_rotation});
  }
  for (std::size_t b = 0; b < balls_.size(); ++b) {
    balls_[b].first_dof = dofs();
    for (int part = 0; part < 3; ++part) dofs_.push_back({{}, static_cast<int>(b), part, true});
  }
}

void Articulation::find_ball(int segment, const Joint& joint) {
  if (joint.axes.size() < 3) return;
  Ball ball;
  ball.segment = segment;
  for (int i = 0; i < 3; ++i) {
    const JointAxis& axis = joint.axes[joint.axes.size() - 3 + static_cast<std::size_t>(i)];
    const auto line = axis.amount.line();
    if (!axis.is_rotation || !axis.coordinate || !line || std::abs(std::abs(line->first) - 1) > 1e-12 ||
        std::abs(line->second) > 1e-12)
      return;
    if (!skeleton_->coordinates[static_cast<std::size_t>(*axis.coordinate)].free()) return;
    ball.coordinates[static_cast<std::size_t>(i)] = *axis.coordinate;
    ball.axes.col(i) = axis.axis;
    ball.signs[i] = line->first;
  }
  if (!(ball.axes.transpose() * ball.axes).isIdentity(1e-9)) return;
  for (const int own : ball.coordinates) {
    int uses = 0;
    for (const Segment& other : skeleton_->segments) {
      for (const JointAxis& axis : other.joint.axes) uses += axis.coordinate == own ? 1 : 0;
    }
    for (const Coordinate& other : skeleton_->coordinates) uses += other.coupling && other.coupling->to == own ? 1 : 0;
    if (uses != 1) return;
  }
  ball_of_segment_[static_cast<std::size_t>(segment)] = static_cast<int>(balls_.size());
  balls_.push_back(ball);
}

SkeletonState Articulation::state_of(std::vector<double> coordinates) const {
  SkeletonState state{std::move(coordinates), {}};
  skeleton_->couple(state.coordinates);
  for (const Ball& ball : balls_) {
    Matrix<3> rotated = Matrix<3>::Identity();
    for (int i = 0; i < 3; ++i) {
      const double angle =
          ball.signs[i] * state.coordinates[static_cast<std::size_t>(ball.coordinates[static_cast<std::size_t>(i)])];
      rotated = rotated * Eigen::AngleAxisd(angle, ball.axes.col(i)).toRotationMatrix();
    }
    state.balls.push_back(rotated);
  }
  return state;
}

void Articulation::move(const SkeletonState& state, const Eigen::VectorXd& step, SkeletonState& moved) const {
  moved = state;
  for (int d = 0; d < dofs(); ++d) {
    if (dofs_[static_cast<std::size_t>(d)].coordinate)
      moved.coordinates[static_cast<std::size_t>(*dofs_[static_cast<std::size_t>(d)].coordinate)] += step[d];
  }
  for (std::size_t b = 0; b < balls_.size(); ++b) {
    moved.balls[b] = state.balls[b] * geometry::rotation_from(step.segment<3>(balls_[b].first_dof));
    // Products of many turns drift off the rotations: one step of Newton's towards the nearest.
    moved.balls[b] = 0.5 * moved.balls[b] * (3 * Matrix<3>::Identity() - moved.balls[b].transpose() * moved.balls[b]);
  }
  skeleton_->couple(moved.coordinates);
}

void Articulation::difference(const SkeletonState& from, const SkeletonState& to, Eigen::VectorXd& step) const {
  for (int d = 0; d < dofs(); ++d) {
    if (const auto& c = dofs_[static_cast<std::size_t>(d)].coordinate)
      step[d] = to.coordinates[static_cast<std::size_t>(*c)] - from.coordinates[static_cast<std::size_t>(*c)];
  }
  for (std::size_t b = 0; b < balls_.size(); ++b) {
    step.segment<3>(balls_[b].first_dof) = geometry::angle_axis_of(from.balls[b].transpose() * to.balls[b]);
  }
}

void Articulation::take_angles(SkeletonState& state) const {
  for (std::size_t b = 0; b < balls_.size(); ++b) {
    const Ball& ball = balls_[b];
    Vector<3> near;
    for (int i = 0; i < 3; ++i)
      near[i] = ball.signs[i] * state.coordinates[static_cast<std::size_t>(ball.coordinates[static_cast<std::size_t>(i)])];
    const Vector<3> angles = rotations_about(state.balls[b], ball.axes, near);
    for (int i = 0; i < 3; ++i)
      state.coordinates[static_cast<std::size_t>(ball.coordinates[static_cast<std::size_t>(i)])] = ball.signs[i] * angles[i];
  }
}

double Articulation::amount(const JointAxis& axis, const SkeletonState& state) const {
  return axis.amount.value(axis.coordinate ? state.coordinates[static_cast<std::size_t>(*axis.coordinate)] : 0);
}

void Articulation::location(const SkeletonState& state) {
  drivers_.clear();
  first_driver_.assign(1, 0);
  for (std::size_t s = 0; s < skeleton_->segments.size(); ++s) {
    const Segment& segment = skeleton_->segments[s];
    Rigid3 world = segment.joint.parent_from_joint;
    if (segment.parent) world = world_from_[static_cast<std::size_t>(*segment.parent)] * world;
    const int ball = ball_of_segment_[s];
    const std::size_t moving = segment.joint.axes.size() - (ball >= 0 ? 3 : 0);
    for (std::size_t a = 0; a < moving; ++a) {
      const JointAxis& axis = segment.joint.axes[a];
      const Vector<3> along = world.rotation * axis.axis;
      if (axis.coordinate) {
        const auto c = static_cast<std::size_t>(*axis.coordinate);
        const auto& coupling = skeleton_->coordinates[c].coupling;
        const std::size_t from = coupling ? static_cast<std::size_t>(coupling->to) : c;
        double slope = axis.amount.slope(state.coordinates[c]);
        if (coupling) slope *= coupling->function.slope(state.coordinates[from]);
        if (dof_of_coordinate_[from] >= 0 && slope != 0) {
          const Vector<3> turn = axis.is_rotation ? Vector<3>(slope * along) : Vector<3>(Vector<3>::Zero());
          drivers_.push_back({dof_of_coordinate_[from], turn,
                              axis.is_rotation ? Vector<3>(world.translation.cross(turn)) : Vector<3>(slope * along)});
        }
      }
      const double by = amount(axis, state);
      if (axis.is_rotation) {
        world.rotation = world.rotation * Eigen::AngleAxisd(by, axis.axis).toRotationMatrix();
      } else {
        world.translation += by * along;
      }
    }
    if (ball >= 0) {
      world.rotation = world.rotation * state.balls[static_cast<std::size_t>(ball)];
      for (int i = 0; i < 3; ++i) {
        const Vector<3> turn = world.rotation.col(i);
        drivers_.push_back({balls_[static_cast<std::size_t>(ball)].first_dof + i, turn, world.translation.cross(turn)});
      }
    }
    world_from_[s] = world * segment.joint.joint_from_segment;
    first_driver_.push_back(drivers_.size());
  }
}

std::optional<SkeletonState> Articulation::with_root_at(const SkeletonState& state, const Rigid3& world_from_root) const {
  const Joint& joint = skeleton_->segments.front().joint;
  const int ball = ball_of_segment_.front();
  if (ball < 0 || joint.axes.size() != 6) return std::nullopt;
  Matrix<3> shifts;
  std::array<int, 3> coordinates{};
  for (int i = 0; i < 3; ++i) {
    const JointAxis& axis = joint.axes[static_cast<std::size_t>(i)];
    const auto line = axis.amount.line();
    if (axis.is_rotation || !axis.coordinate || !line || line->second != 0) return std::nullopt;
    if (!skeleton_->coordinates[static_cast<std::size_t>(*axis.coordinate)].free()) return std::nullopt;
    shifts.col(i) = axis.axis * line->first;
    coordinates[static_cast<std::size_t>(i)] = *axis.coordinate;
  }
  if (std::abs(shifts.determinant()) < 1e-6) return std::nullopt;
  const Rigid3 joint_motion = joint.parent_from_joint.inverse() * world_from_root * joint.joint_from_segment.inverse();
  SkeletonState moved = state;
  const Vector<3> amounts = shifts.inverse() * joint_motion.translation;
  for (int i = 0; i < 3; ++i) moved.coordinates[static_cast<std::size_t>(coordinates[static_cast<std::size_t>(i)])] = amounts[i];
  moved.balls[static_cast<std::size_t>(ball)] = joint_motion.rotation;
  return moved;
}

}  // namespace marey::solve::skeleton
