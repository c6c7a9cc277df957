#include "marey/solve/skeleton/inverse_dynamics.h"

#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace marey::solve::skeleton {
namespace {

constexpr unsigned kSeed = 38;

/// A tree of five segments with every kind of axis: shifts and turns of the root, a knee whose shifts are splines of its angle, a
/// weld, a branch. One coordinate turns about two axes, as Arnold's knee about three.
class InverseDynamicsTest : public testing::Test {
 protected:
  InverseDynamicsTest() : random_(kSeed) {
    for (int i = 0; i < 12; ++i) {
      Coordinate coordinate;
      coordinate.name = std::to_string(i);
      skeleton_.coordinates.push_back(coordinate);
    }
    add({}, {shift(0, 0), shift(1, 1), shift(2, 2), turn(3), turn(4), turn(5)});
    add(0, {turn(6), turn(7), turn(8)});
    JointAxis x = shift(9, 0), y = shift(9, 1);
    x.amount = CoordinateFunction::spline({-3, -1.5, 0, 1, 2, 3}, {-0.03, 0.01, 0.02, -0.01, 0.04, 0.0});
    y.amount = CoordinateFunction::polynomial({-0.4, 0.02, -0.013, 0.004}).times(1.1);
    JointAxis tilted = turn(9);
    tilted.amount = CoordinateFunction::polynomial({0.1, 0.9, 0.05});
    JointAxis screwed = turn(9);
    screwed.amount = CoordinateFunction::spline({-3, -1, 0, 1, 3}, {0.2, -0.3, 0.1, 0.3, -0.1});
    add(1, {x, y, tilted, screwed});
    add(2, {});  // a weld
    add(0, {turn(10), shift(11, 2)});
  }

  double number(double scale = 1) { return scale * std::uniform_real_distribution<double>(-1, 1)(random_); }
  Vector<3> vector(double scale = 1) { return {number(scale), number(scale), number(scale)}; }
  Rigid3 random_pose() {
    const Vector<3> turned = vector();
    return {Eigen::AngleAxisd(turned.norm(), turned.normalized()).toRotationMatrix(), vector(0.3)};
  }
  static JointAxis shift(int coordinate, int along) { return {false, Vector<3>::Unit(along), {}, coordinate}; }
  JointAxis turn(int coordinate) { return {true, vector().normalized(), {}, coordinate}; }
  void add(std::optional<int> parent, std::vector<JointAxis> axes) {
    Segment segment;
    segment.parent = parent;
    segment.joint = {random_pose(), std::move(axes), random_pose()};
    skeleton_.segments.push_back(segment);
    SegmentMass mass{.mass_kg = 2 + number(), .centre = vector(0.2)};
    const Matrix<3> root =
        Matrix<3>::Identity() * 0.3 + Matrix<3>(0.1 * Matrix<3>::NullaryExpr([&](Eigen::Index) { return number(); }));
    mass.inertia = root * root.transpose();
    masses_.push_back(mass);
  }

  std::vector<double> random_row(double scale) {
    std::vector<double> row(skeleton_.coordinates.size());
    for (double& value : row) value = number(scale);
    return row;
  }

  Skeleton skeleton_;
  std::vector<SegmentMass> masses_;
  std::mt19937 random_;
};

/// Kinetic and potential energy at q, q̇, with velocities by central differences of the poses.
struct SlowEnergy {
  const Skeleton& skeleton;
  const std::vector<SegmentMass>& masses;

  double potential(const std::vector<double>& q) const {
    const std::vector<Rigid3> poses = pose_of(skeleton, q);
    double sum = 0;
    for (std::size_t s = 0; s < poses.size(); ++s) sum += masses[s].mass_kg * kGravity * (poses[s] * masses[s].centre).z();
    return sum;
  }
  double kinetic(const std::vector<double>& q, const std::vector<double>& speed) const {
    constexpr double kStep = 1e-5;
    std::vector<double> before = q, after = q;
    for (std::size_t c = 0; c < q.size(); ++c) {
      before[c] -= kStep * speed[c];
      after[c] += kStep * speed[c];
    }
    const std::vector<Rigid3> a = pose_of(skeleton, before), b = pose_of(skeleton, after), now = pose_of(skeleton, q);
    double sum = 0;
    for (std::size_t s = 0; s < now.size(); ++s) {
      const Vector<3> velocity = (b[s] * masses[s].centre - a[s] * masses[s].centre) / (2 * kStep);
      const Matrix<3> spin = (b[s].rotation - a[s].rotation) / (2 * kStep) * now[s].rotation.transpose();
      const Vector<3> angular_velocity(spin(2, 1), spin(0, 2), spin(1, 0));
      const Matrix<3> inertia = now[s].rotation * masses[s].inertia * now[s].rotation.transpose();
      sum += 0.5 * masses[s].mass_kg * velocity.squaredNorm() + 0.5 * angular_velocity.dot(inertia * angular_velocity);
    }
    return sum;
  }
};

/// Lagrange: d/dt ∂T/∂q̇ − ∂T/∂q + ∂V/∂q, all by differences. T is a quadratic form of q̇, so its own second differences are exact.
std::vector<double> slow_forces(const SlowEnergy& energy, const CoordinateMotion& motion) {
  constexpr double kStep = 1e-4;
  const std::size_t n = motion.value.size();
  const auto momentum = [&](const std::vector<double>& q, const std::vector<double>& speed, std::size_t c) {
    std::vector<double> less = speed, more = speed;
    less[c] -= 1;
    more[c] += 1;
    return (energy.kinetic(q, more) - energy.kinetic(q, less)) / 2;
  };
  std::vector<double> forces(n);
  for (std::size_t c = 0; c < n; ++c) {
    std::vector<double> q_before(n), q_after(n), v_before(n), v_after(n), q_less = motion.value, q_more = motion.value;
    for (std::size_t i = 0; i < n; ++i) {
      const double q = motion.value[i], v = motion.speed[i], a = motion.acceleration[i];
      q_before[i] = q - kStep * v + kStep * kStep * a / 2;
      q_after[i] = q + kStep * v + kStep * kStep * a / 2;
      v_before[i] = v - kStep * a;
      v_after[i] = v + kStep * a;
    }
    q_less[c] -= kStep;
    q_more[c] += kStep;
    forces[c] = (momentum(q_after, v_after, c) - momentum(q_before, v_before, c)) / (2 * kStep) -
                (energy.kinetic(q_more, motion.speed) - energy.kinetic(q_less, motion.speed)) / (2 * kStep) +
                (energy.potential(q_more) - energy.potential(q_less)) / (2 * kStep);
  }
  return forces;
}

TEST_F(InverseDynamicsTest, AgreesWithLagrangeByDifferences) {
  const SlowEnergy energy{skeleton_, masses_};
  for (int run = 0; run < 5; ++run) {
    const CoordinateMotion motion{random_row(1), random_row(2), random_row(5)};
    const std::vector<double> fast = inverse_dynamics(skeleton_, masses_, motion, {}), slow = slow_forces(energy, motion);
    for (std::size_t c = 0; c < fast.size(); ++c)
      EXPECT_NEAR(fast[c], slow[c], 2e-4 * (10 + std::abs(slow[c]))) << c << ", seed " << kSeed;
  }
}

TEST_F(InverseDynamicsTest, LoadsActByTheWorkTheyDo) {
  constexpr double kStep = 1e-6;
  const CoordinateMotion motion{random_row(1), random_row(1), random_row(1)};
  const Vector<3> in_segment = vector(0.2), force = vector(100), moment = vector(10);
  const int segment = 3;
  const SegmentLoad load{segment, force, pose_of(skeleton_, motion.value)[3] * in_segment, moment};
  const std::vector<double> without = inverse_dynamics(skeleton_, masses_, motion, {});
  const std::vector<double> with = inverse_dynamics(skeleton_, masses_, motion, std::span(&load, 1));
  for (std::size_t c = 0; c < without.size(); ++c) {
    std::vector<double> less = motion.value, more = motion.value;
    less[c] -= kStep;
    more[c] += kStep;
    const Rigid3 a = pose_of(skeleton_, less)[3], b = pose_of(skeleton_, more)[3], now = pose_of(skeleton_, motion.value)[3];
    const Matrix<3> spin = (b.rotation - a.rotation) / (2 * kStep) * now.rotation.transpose();
    const double work =
        force.dot(b * in_segment - a * in_segment) / (2 * kStep) + moment.dot(Vector<3>(spin(2, 1), spin(0, 2), spin(1, 0)));
    EXPECT_NEAR(without[c] - with[c], work, 1e-5 * (1 + std::abs(work))) << c << ", seed " << kSeed;
  }
}

TEST_F(InverseDynamicsTest, FreeFallNeedsNoForce) {
  CoordinateMotion motion{random_row(1), std::vector<double>(12, 0.0), std::vector<double>(12, 0.0)};
  // The first three shifts are along the axes of the first frame, which is turned in the world.
  const Vector<3> down = skeleton_.segments[0].joint.parent_from_joint.rotation.transpose() * Vector<3>(0, 0, -kGravity);
  for (int i = 0; i < 3; ++i) motion.acceleration[static_cast<std::size_t>(i)] = down[i];
  for (const double force : inverse_dynamics(skeleton_, masses_, motion, {})) EXPECT_NEAR(force, 0, 1e-12);
}

TEST_F(InverseDynamicsTest, CoupledCoordinatesFollowWithTheirDerivatives) {
  skeleton_.coordinates[5].coupling = {4, CoordinateFunction::polynomial({0.1, 2, 3})};
  CoordinateMotion motion{random_row(1), random_row(1), random_row(1)};
  couple(skeleton_, motion);
  const double q = motion.value[4], v = motion.speed[4], a = motion.acceleration[4];
  EXPECT_NEAR(motion.value[5], 0.1 + 2 * q + 3 * q * q, 1e-12);
  EXPECT_NEAR(motion.speed[5], (2 + 6 * q) * v, 1e-12);
  EXPECT_NEAR(motion.acceleration[5], (2 + 6 * q) * a + 6 * v * v, 1e-12);
}

}  // namespace
}  // namespace marey::solve::skeleton
