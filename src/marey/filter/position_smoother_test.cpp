#include "marey/filter/position_smoother.h"

#include <limits>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "marey/filter/smoother.h"

namespace marey::filter {
namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();

struct Scene {
  std::vector<double> times, variances;
  std::vector<Eigen::Matrix<double, 1, 2>> locations;
};

Scene scene_of(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Scene scene;
  double time = 0;
  for (int i = 0; i < 12; ++i) {
    scene.times.push_back(time);
    time += 0.1 + 0.2 * std::abs(normal(random));
    scene.variances.push_back(i % 5 == 3 ? kNothing : 0.3 + std::abs(normal(random)));
    scene.locations.emplace_back(normal(random), i + normal(random));
  }
  return scene;
}

constexpr double kUnknown = 25;
constexpr WhiteAcceleration kMotion{.noise = 1.4};

/// By brute force: all states' joint distribution, conditioned on all observations at once.
struct Joint {
  Eigen::MatrixXd mean, covariance;

  explicit Joint(const Scene& scene) {
    const auto n = static_cast<Eigen::Index>(scene.times.size());
    mean = Eigen::MatrixXd::Zero(2 * n, 2);
    covariance = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    mean.row(0) = scene.locations[0];
    covariance.topLeftCorner<2, 2>() = Vector<2>(scene.variances[0], kUnknown).asDiagonal();
    for (Eigen::Index k = 1; k < n; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const auto step = kMotion.over(scene.times[i] - scene.times[i - 1]);
      mean.middleRows(2 * k, 2) = step.F * mean.middleRows(2 * k - 2, 2);
      covariance.block(2 * k, 0, 2, 2 * k) = step.F * covariance.block(2 * k - 2, 0, 2, 2 * k);
      covariance.block(0, 2 * k, 2 * k, 2) = covariance.block(2 * k, 0, 2, 2 * k).transpose();
      covariance.block(2 * k, 2 * k, 2, 2) = step.F * covariance.block(2 * k - 2, 2 * k - 2, 2, 2) * step.F.transpose() + step.Q;
    }
    std::vector<Eigen::Index> detected;
    for (Eigen::Index k = 1; k < n; ++k) {
      if (std::isfinite(scene.variances[static_cast<std::size_t>(k)])) detected.push_back(k);
    }
    const auto count = static_cast<Eigen::Index>(detected.size());
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(count, 2 * n), z(count, 2);
    Eigen::VectorXd R(count);
    for (Eigen::Index r = 0; r < count; ++r) {
      const Eigen::Index k = detected[static_cast<std::size_t>(r)];
      H(r, 2 * k) = 1;
      z.row(r) = scene.locations[static_cast<std::size_t>(k)];
      R[r] = scene.variances[static_cast<std::size_t>(k)];
    }
    const Eigen::MatrixXd S = H * covariance * H.transpose() + Eigen::MatrixXd(R.asDiagonal());
    const Eigen::MatrixXd gain = S.ldlt().solve(H * covariance).transpose();
    mean += gain * (z - H * mean);
    covariance -= gain * H * covariance;
  }
};

TEST(PositionSmoother, EqualsConditionedJointDistribution) {
  for (unsigned seed = 1; seed < 6; ++seed) {
    const Scene scene = scene_of(seed);
    const Joint joint(scene);
    const auto states = smoothed_positions<WhiteAcceleration, 2>(kMotion, scene.times, scene.locations, scene.variances, kUnknown);
    for (std::size_t i = 0; i < states.size(); ++i)
      EXPECT_TRUE(states[i].isApprox(joint.mean.middleRows(2 * static_cast<Eigen::Index>(i), 2), 1e-8)) << i;
  }
}

TEST(PositionSmoother, CovariancesAndCoupledCoordinatesToo) {
  const Scene scene = scene_of(7);
  const Joint joint(scene);
  using Coupled = PositionSmoother<WhiteAcceleration, 2>;
  Coupled::State first;
  first.x[0] = scene.locations[0].transpose();
  first.P[0] = scene.variances[0] * Matrix<2>::Identity();
  first.P[2] = kUnknown * Matrix<2>::Identity();
  // In coordinates that are turned and stretched, errors go together.
  const Matrix<2> turn = (Matrix<2>() << 0.8, -0.7, 0.3, 1.1).finished();
  for (Vector<2>& x : first.x) x = turn * x;
  for (Matrix<2>& P : first.P) P = (turn * P * turn.transpose()).eval();
  // The motion's noise must be the same in all directions there: so it is only without any.
  const WhiteAcceleration still{.noise = 0};
  Coupled smoother(still, first);
  smoother.add_unobserved(0);
  PositionSmoother<WhiteAcceleration, 1, 2>::State plain_first;
  plain_first.x[0] = scene.locations[0];
  plain_first.P[0].setConstant(scene.variances[0]);
  plain_first.P[2].setConstant(kUnknown);
  PositionSmoother<WhiteAcceleration, 1, 2> plain(still, plain_first);
  plain.add_unobserved(0);
  for (std::size_t i = 1; i < scene.times.size(); ++i) {
    const double dt = scene.times[i] - scene.times[i - 1];
    if (std::isfinite(scene.variances[i])) {
      smoother.add(dt, 1, turn * scene.locations[i].transpose(), scene.variances[i] * turn * turn.transpose());
      plain.add(dt, 1, scene.locations[i], Matrix<1>(scene.variances[i]));
    } else {
      smoother.add_unobserved(dt);
      plain.add_unobserved(dt);
    }
  }
  const auto coupled = smoother.smoothed();
  const auto alone = plain.smoothed();
  const auto covariances = smoother.position_covariances();
  const auto variances = plain.position_covariances();
  for (std::size_t i = 0; i < coupled.size(); ++i) {
    EXPECT_TRUE(coupled[i][0].isApprox(turn * alone[i][0].transpose(), 1e-9));
    EXPECT_TRUE(coupled[i][1].isApprox(turn * alone[i][1].transpose(), 1e-9));
    EXPECT_TRUE(covariances[i].isApprox(variances[i](0) * turn * turn.transpose(), 1e-7));
  }
}

/// Both forms of the backward pass give the same, covariances included.
TEST(Smoother, EqualsTheAdjointsForm) {
  const Scene scene = scene_of(3);
  const Joint joint(scene);
  Smoother<2, 2> smoother;
  Estimate<2, 2> now;
  now.mean.row(0) = scene.locations[0];
  now.covariance = Vector<2>(scene.variances[0], kUnknown).asDiagonal();
  smoother.add(Matrix<2>::Identity(), now, now);
  for (std::size_t i = 1; i < scene.times.size(); ++i) {
    const auto step = kMotion.over(scene.times[i] - scene.times[i - 1]);
    now.mean = (step.F * now.mean).eval();
    now.covariance = (step.F * now.covariance * step.F.transpose() + step.Q).eval();
    const Estimate<2, 2> expected = now;
    if (std::isfinite(scene.variances[i])) {
      const Vector<2> K = expected.covariance.col(0) / (expected.covariance(0, 0) + scene.variances[i]);
      now.mean += K * (scene.locations[i] - expected.mean.row(0));
      now.covariance -= K * expected.covariance.row(0);
    }
    smoother.add(step.F, expected, now);
  }
  const auto all = smoother.smoothed();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto k = 2 * static_cast<Eigen::Index>(i);
    EXPECT_TRUE(all[i].mean.isApprox(joint.mean.middleRows(k, 2), 1e-8)) << i;
    EXPECT_TRUE(all[i].covariance.isApprox(joint.covariance.block(k, k, 2, 2), 1e-7)) << i;
  }
}

}  // namespace
}  // namespace marey::filter
