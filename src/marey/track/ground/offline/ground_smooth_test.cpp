#include "marey/track/ground/offline/ground_smooth.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace marey::track::ground::offline {
namespace {

struct Scene {
  std::vector<GroundSample> samples;
  std::vector<Timestamp> times;
};

GroundSample sample(int instant, const Vector<2>& location, double xx, double xy, double yy) {
  GroundSample sample;
  sample.instant = instant;
  sample.location = {static_cast<float>(location.x()), static_cast<float>(location.y())};
  sample.covariance = {static_cast<float>(xx), static_cast<float>(xy), static_cast<float>(yy)};
  sample.cameras = 1;
  return sample;
}

/// A path with instants at uneven times, not all of them seen, each with another covariance.
Scene random_scene(std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  Scene scene;
  double time = 0;
  Vector<2> location(10, 20);
  Vector<2> velocity(3, -1);
  for (int k = 0; k < 60; ++k) {
    const double dt = unit(engine) < 0.1 ? 0.02 : 0.1 + unit(engine);
    time += dt;
    velocity += Vector<2>(normal(engine), normal(engine));
    location += dt * velocity;
    scene.times.push_back(timestamp_from_seconds(time));
    if (k > 0 && unit(engine) < 0.3) continue;
    const double xx = 0.01 + unit(engine), yy = 0.01 + unit(engine);
    const double xy = 0.8 * (2 * unit(engine) - 1) * std::sqrt(xx * yy);
    scene.samples.push_back(sample(k, location + 0.3 * Vector<2>(normal(engine), normal(engine)), xx, xy, yy));
  }
  return scene;
}

/// Places, velocities and accelerations in one least-squares problem, solved densely: the same answer, without a filter.
std::vector<GroundTimeStep> twin(const Scene& scene, const GroundMotion& motion) {
  const auto n = static_cast<Eigen::Index>(scene.samples.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(6 * n, 6 * n);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(6 * n);
  const double density = std::pow(motion.acceleration / motion.push, 2);
  // Small steps of Euler's, from rest for long: what velocity and acceleration tend to; and for each pair of samples F and Q.
  const auto run = [&](double seconds, double h, Matrix<3>& F, Matrix<3>& Q) {
    Matrix<3> one = Matrix<3>::Identity();
    one(0, 1) = one(1, 2) = h;
    one(0, 2) = h * h / 2;
    one(1, 1) = std::exp(-h / motion.settling);
    one(2, 2) = std::exp(-h / motion.push);
    F.setIdentity();
    Q.setZero();
    for (int k = static_cast<int>(std::lround(seconds / h)); k > 0; --k) {
      Q = (one * Q * one.transpose()).eval();
      Q(2, 2) += density * h;
      F = (one * F).eval();
    }
  };
  Matrix<3> F, Q;
  run(60, 1e-3, F, Q);
  const Matrix<2> moves = Q.bottomRightCorner<2, 2>().inverse();
  for (int axis = 0; axis < 2; ++axis) {
    for (int r = 0; r < 2; ++r) {
      for (int c = 0; c < 2; ++c) A(2 + 2 * r + axis, 2 + 2 * c + axis) += moves(r, c);
    }
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const GroundSample& detected = scene.samples[i];
    const Matrix<2> W = detected.spread().inverse();
    A.block<2, 2>(6 * i, 6 * i) += W;
    b.segment<2>(6 * i) += W * detected.at();
    if (i == 0) continue;
    const double dt = seconds(scene.times[detected.instant] - scene.times[scene.samples[i - 1].instant]);
    run(dt, dt / 2000, F, Q);
    Eigen::Matrix<double, 3, 6> difference;
    difference << -F, Matrix<3>::Identity();
    const Matrix<6> link = difference.transpose() * Q.inverse() * difference;
    const auto at = [&](int k, int axis) { return 6 * (k < 3 ? i - 1 : i) + 2 * (k % 3) + axis; };
    for (int axis = 0; axis < 2; ++axis) {
      for (int r = 0; r < 6; ++r) {
        for (int c = 0; c < 6; ++c) A(at(r, axis), at(c, axis)) += link(r, c);
      }
    }
  }
  const Eigen::MatrixXd covariance = A.fullPivLu().inverse();
  const Eigen::VectorXd x = covariance * b;
  std::vector<GroundTimeStep> time_steps(static_cast<std::size_t>(n));
  for (Eigen::Index i = 0; i < n; ++i) {
    time_steps[i].location = x.segment<2>(6 * i);
    time_steps[i].velocity = x.segment<2>(6 * i + 2);
    time_steps[i].spread = covariance.block<2, 2>(6 * i, 6 * i);
  }
  return time_steps;
}

TEST(GroundSmooth, IsTheLeastSquaresPath) {
  const GroundMotion motion{.error_memory = 0};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scene scene = random_scene(seed);
    const auto path = smooth_ground(scene.samples, scene.times, motion, 1);
    const auto expected = twin(scene, motion);
    for (std::size_t i = 0; i < path.size(); ++i) {
      // The first place is not quite unknown to the filter; the dense twin knows nothing, and takes small steps of Euler's.
      EXPECT_NEAR((path[i].location - expected[i].location).norm(), 0, 0.01) << "seed " << seed << ", sample " << i;
      EXPECT_NEAR((path[i].velocity - expected[i].velocity).norm(), 0, 0.02) << "seed " << seed << ", sample " << i;
      EXPECT_NEAR((path[i].spread - expected[i].spread).norm(), 0, 0.01 * expected[i].spread.norm())
          << "seed " << seed << ", sample " << i;
    }
  }
}

TEST(GroundSmooth, BetweenTwoMomentsIsWhereTheSmootherPutsWhatIsHardlySeen) {
  const GroundMotion motion{.calm = 1, .error_memory = 0};
  Scene scene = random_scene(7);
  const std::size_t middle = 20;
  scene.samples[middle].covariance = {1e6F, 0, 1e6F};
  const auto path = smooth_ground(scene.samples, scene.times, motion, 1);
  const auto time = [&](std::size_t i) { return scene.times[scene.samples[i].instant]; };
  using Bridge = filter::Bridge<GroundMotion, 2>;
  const auto state = [&](std::size_t i) {
    Bridge::State all;
    all << path[i].location.transpose(), path[i].velocity.transpose(), path[i].acceleration.transpose();
    return all;
  };
  const auto since = [&](std::size_t i) { return seconds(time(i) - time(middle - 1)); };
  const Bridge gap(state(middle - 1), 0, state(middle + 1), since(middle + 1), motion);
  const Bridge::State filled = gap.at(since(middle));
  EXPECT_NEAR((filled.row(0).transpose() - path[middle].location).norm(), 0, 1e-3);
  EXPECT_NEAR((filled.row(1).transpose() - path[middle].velocity).norm(), 0, 1e-3);
}

TEST(GroundSmooth, EndsAreWhatTheSmootherSaysOfThem) {
  const GroundMotion motion{.calm = 1};
  const Scene scene = random_scene(3);
  const auto path = smooth_ground(scene.samples, scene.times, motion);
  const GroundState first = first_state(scene.samples, scene.times, motion, 1e6);
  const GroundState last = last_state(scene.samples, scene.times, motion, 1e6);
  EXPECT_NEAR((first.location() - path.front().location).norm(), 0, 0.02);
  EXPECT_NEAR((first.velocity() - path.front().velocity).norm(), 0, 0.02);
  EXPECT_NEAR((last.location() - path.back().location).norm(), 0, 0.02);
  EXPECT_NEAR((last.velocity() - path.back().velocity).norm(), 0, 0.02);
}

TEST(GroundSmooth, DownweightsOutliers) {
  Scene scene;
  for (int k = 0; k < 100; ++k) {
    scene.times.push_back(timestamp_from_seconds(0.04 * k));
    const bool wrong = k >= 50 && k < 53;
    scene.samples.push_back(sample(k, Vector<2>(0.2 * k, wrong ? 3.0 : 0.0), 0.01, 0, 0.01));
  }
  const auto once = smooth_ground(scene.samples, scene.times, {}, 1);
  const auto path = smooth_ground(scene.samples, scene.times, {}, 4);
  EXPECT_GT(std::abs(once[51].location.y()), 0.5);
  EXPECT_LT(std::abs(path[51].location.y()), 0.15);
  EXPECT_LT(path[51].fit, 0.1);
  EXPECT_GT(path[20].fit, 1);
}

/// m that a smoothed path goes, and its fastest instant.
struct Trajectory {
  double length = 0, fastest = 0;
};

/// A person who stands, sprints for two seconds and stands again, seen with errors that persist for `memory` s.
Trajectory sprint(double rate_hz, double memory, const GroundMotion& motion) {
  std::mt19937_64 engine(11);
  std::normal_distribution<double> normal;
  Scene scene;
  const double dt = 1 / rate_hz, kept = memory > 0 ? std::exp(-dt / memory) : 0;
  Vector<2> error = Vector<2>::Zero();
  double location = 0, speed = 0;
  for (int k = 0; k < 40 * rate_hz; ++k) {
    const double t = k * dt;
    speed += dt * std::clamp((t > 20 && t < 23 ? 8.0 : 0.0) - speed, -1.0, 1.0) * 5;
    location += dt * speed;
    error = kept * error + 0.3 * std::sqrt(1 - kept * kept) * Vector<2>(normal(engine), normal(engine));
    scene.times.push_back(timestamp_from_seconds(t));
    scene.samples.push_back(sample(k, Vector<2>(location, 0) + error, 0.09, 0, 0.09));
  }
  const auto path = smooth_ground(scene.samples, scene.times, motion);
  Trajectory method;
  for (std::size_t i = 1; i < path.size(); ++i) {
    method.length += (path[i].location - path[i - 1].location).norm();
    method.fastest = std::max(method.fastest, path[i].velocity.norm());
  }
  return method;
}

TEST(GroundSmooth, StandingHasNoSpeedAndSprintKeepsIt) {
  const Trajectory plain = sprint(25, 0.05, {.calm = 1, .error_memory = 0});
  const Trajectory calm = sprint(25, 0.05, {});
  EXPECT_GT(plain.length, 30) << "the scene is too easy";
  EXPECT_LT(calm.length, plain.length - 5);
  EXPECT_GT(calm.fastest, 7.2);
  EXPECT_LT(calm.fastest, 8.8);
}

TEST(GroundSmooth, MoreFramesOfErrorsThatPersistAreNoMoreEvidence) {
  const Trajectory slow = sprint(25, 0.05, {}), fast = sprint(100, 0.05, {});
  EXPECT_NEAR(fast.length, slow.length, 0.15 * slow.length);
}

}  // namespace
}  // namespace marey::track::ground::offline
