// An extended Kalman filter of six dimensions. Gravity makes the depth of an arc observable to one camera: how fast an image's arc
// bends is how near it is. Each bounce is reflected at the ground, with the height at that instant as a measurement.
#include "marey/track/ball/ball_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>

namespace marey::track::ball {
namespace {

constexpr double kGravity = 9.81;    // m/s²
constexpr double kStationary = 0.2;  // what curl does upwards, of what it does sideways: depth is read off the fall

/// Constant acceleration's noise over a step.
void add_wander(Matrix<6>& covariance, double accel, double step, int first, int last) {
  const double q = accel * accel * step;  // as if it changed at random all the time
  for (int axis = first; axis <= last; ++axis) {
    covariance(axis, axis) += q * step * step / 3;
    covariance(axis, axis + 3) += q * step / 2;
    covariance(axis + 3, axis) += q * step / 2;
    covariance(axis + 3, axis + 3) += q;
  }
}

/// One number of the state, or a sum of some, is known to be `value` up to `sigma`. Returns the squared distance.
double measure(BallBelief& belief, int coordinate, double value, double sigma) {
  const Vector<6> column = belief.covariance.col(coordinate);
  const double spread = column[coordinate] + sigma * sigma;
  const double off = value - belief.mean[coordinate];
  belief.mean += column / spread * off;
  belief.covariance -= column * column.transpose() / spread;
  return off * off / spread;
}

void forget_velocity(BallPrediction& to, const Vector<3>& mean, const Vector<3>& sigma) {
  to.F.bottomRows<3>().setZero();
  to.belief.mean.tail<3>() = mean;
  to.belief.covariance.bottomRows<3>().setZero();
  to.belief.covariance.rightCols<3>().setZero();
  to.belief.covariance.bottomRightCorner<3, 3>() = sigma.cwiseAbs2().asDiagonal();
}

void move(BallPrediction& to, const Matrix<6>& F) {
  to.belief.covariance = F * to.belief.covariance * F.transpose();
  to.F = F * to.F;
}

Matrix<6> uniform_motion(double step) {
  Matrix<6> F = Matrix<6>::Identity();
  F.topRightCorner<3, 3>() = step * Matrix<3>::Identity();
  return F;
}

void roll(BallPrediction& to, double step, const BallMotionOptions& options) {
  Vector<6>& x = to.belief.mean;
  const double speed = x.segment<2>(3).norm();
  const double slower = speed > 0 ? std::max(0.0, 1 - step * (options.grass / speed + options.drag * speed)) : 1;
  Matrix<6> F = uniform_motion(step);
  F(3, 3) = F(4, 4) = slower;
  x.head<3>() += step * x.tail<3>();
  x.segment<2>(3) *= slower;
  move(to, F);
  add_wander(to.belief.covariance, options.roll_accel, step, 0, 1);
  add_wander(to.belief.covariance, 0.1, step, 2, 2);
}

void fly(BallPrediction& to, double step, const BallMotionOptions& options) {
  Vector<6>& x = to.belief.mean;
  const Vector<3> v = x.tail<3>();
  const double speed = v.norm();
  Vector<3> pull = -options.drag * speed * v;
  pull.z() -= kGravity;
  Matrix<6> F = uniform_motion(step);
  Matrix<3> by_velocity = -options.drag * speed * Matrix<3>::Identity();
  if (speed > 0) by_velocity -= options.drag / speed * v * v.transpose();
  F.bottomRightCorner<3, 3>() += step * by_velocity;
  x.head<3>() += step * v + 0.5 * step * step * pull;
  x.tail<3>() += step * pull;
  move(to, F);
  add_wander(to.belief.covariance, options.flight_accel, step, 0, 1);
  add_wander(to.belief.covariance, kStationary * options.flight_accel, step, 2, 2);
}

/// Height and velocity are reflected at the ground, and the velocity loses its share.
void bounce(BallPrediction& to, const BallMotionOptions& options) {
  Vector<6>& x = to.belief.mean;
  Matrix<6> F = Matrix<6>::Identity();
  F(2, 2) = -1;
  F(5, 5) = -options.restitution;
  F(3, 3) = F(4, 4) = options.along;
  x[2] = 2 * kBallRadius - x[2];
  x[5] *= -options.restitution;
  x.segment<2>(3) *= options.along;
  move(to, F);
  for (const int axis : {3, 4, 5}) to.belief.covariance(axis, axis) += 0.8;
}

void carry(BallPrediction& to, double step, const BallPerson& holder, const BallMotionOptions& options) {
  constexpr double kFrame = 1.0 / 25;  // s
  Vector<6>& x = to.belief.mean;
  const Vector<3> velocity(holder.velocity.x(), holder.velocity.y(), 0);
  x.head<3>() += step * velocity;
  forget_velocity(to, velocity, {2, 2, 0.3});
  const double wander = options.hold_wander * options.hold_wander * step / kFrame;
  to.belief.covariance(0, 0) += wander;
  to.belief.covariance(1, 1) += wander;
  to.belief.covariance(2, 2) += 0.01;
}

}  // namespace

BallPrediction predict(const BallBelief& before, BallMode mode, BallEvent event, double step, const BallPerson* holder,
                       const BallMotionOptions& options) {
  BallPrediction to{before, Matrix<6>::Identity()};
  if (event == BallEvent::kick) {
    const bool up = mode == BallMode::flying;
    const double v = options.kick_speed;
    forget_velocity(to, {0, 0, up ? options.kick_up : 0}, {v, v, up ? options.kick_up : 0.3});
    to.belief.covariance.topLeftCorner<2, 2>().diagonal().array() += 0.02;
  }
  switch (mode) {
    case BallMode::rolling:
      roll(to, step, options);
      break;
    case BallMode::flying:
      fly(to, step, options);
      break;
    case BallMode::held:
      carry(to, step, *holder, options);
      break;
    case BallMode::lost:
      break;
  }
  if (event == BallEvent::bounce) bounce(to, options);
  return to;
}

double settle(BallBelief& belief, BallMode mode, BallEvent event, double step, const BallPerson* holder,
              const BallMotionOptions& options) {
  double squared = 0;
  if (event == BallEvent::bounce)  // the height is the ground's, up to what it moves in the step
    squared += measure(belief, 2, kBallRadius, 0.05 + 0.4 * std::abs(belief.mean[5]) * step);
  if (mode == BallMode::rolling) {
    squared += measure(belief, 2, kBallRadius, 0.04);
    squared += measure(belief, 5, 0, 0.5);
  } else if (mode == BallMode::held) {
    squared += measure(belief, 0, holder->location.x(), options.hold_radius);
    squared += measure(belief, 1, holder->location.y(), options.hold_radius);
    squared += measure(belief, 2, kBallRadius, 0.15);
  }
  return -0.5 * squared;
}

std::optional<BallProjection> project(const BallBelief& belief, const GroundView& view, const std::optional<Vector<3>>& around) {
  const Vector<3> here = around.value_or(belief.location());
  Vector<3> at = here;
  at.z() += view.surface().height(at.head<2>());
  const auto detected = view.camera()->project_with_jacobian(at);
  if (!detected) return std::nullopt;
  BallProjection projection;
  projection.pixel = detected->pixel + detected->by_world * (belief.location() - here);
  projection.radius = kBallRadius * std::pow((detected->by_world * detected->by_world.transpose()).determinant(), 0.25);
  projection.by_state.setZero();
  projection.by_state.leftCols<3>() = detected->by_world;
  projection.spread = projection.by_state * belief.covariance * projection.by_state.transpose();
  return projection;
}

double correct(BallBelief& belief, const BallProjection& observed_at, const BallSighting& sighting) {
  const Matrix<2> spread = observed_at.spread + sighting.sigma * sighting.sigma * Matrix<2>::Identity();
  const Vector<2> off = sighting.pixel - observed_at.pixel;
  const Matrix<2> inverse = spread.inverse();
  const Eigen::Matrix<double, 6, 2> gain = belief.covariance * observed_at.by_state.transpose() * inverse;
  belief.mean += gain * off;
  belief.covariance -= gain * observed_at.by_state * belief.covariance;
  belief.covariance = 0.5 * (belief.covariance + belief.covariance.transpose().eval());
  return -0.5 * off.dot(inverse * off) - std::log(2 * 3.14159265358979 * std::sqrt(spread.determinant()));
}

}  // namespace marey::track::ball
