#include "marey/filter/bridge.h"

#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace marey::filter {
namespace {

TEST(Bridge, OfARandomWalkIsTheStraightLine) {
  const Bridge<RandomWalk, 3> bridge(Vector<3>(1, 2, 3).transpose(), 2, Vector<3>(5, 2, -1).transpose(), 4);
  EXPECT_TRUE(bridge.at(2.5).transpose().isApprox(Vector<3>(2, 2, 2)));
  EXPECT_NEAR(bridge.covariance(2.5)(0, 0), 0.5 * 1.5 / 2, 1e-12) << "Brownian bridge";
}

TEST(Bridge, OfWhiteAccelerationIsHermitesCubic) {
  const double T = 0.7, a = 3, va = -2, b = 4.5, vb = 6;
  Matrix<2> ends;
  ends << a, b, va, vb;
  const Bridge<WhiteAcceleration, 1> bridge(Vector<2>(a, va), 0, Vector<2>(b, vb), T, {.noise = 3});
  for (const double u : {0.01, 0.3, 0.5, 0.99}) {
    const double u2 = u * u, u3 = u2 * u;
    const double cubic = (2 * u3 - 3 * u2 + 1) * a + (u3 - 2 * u2 + u) * va * T + (-2 * u3 + 3 * u2) * b + (u3 - u2) * vb * T;
    const double slope =
        ((6 * u2 - 6 * u) * a + (3 * u2 - 4 * u + 1) * va * T + (-6 * u2 + 6 * u) * b + (3 * u2 - 2 * u) * vb * T) / T;
    EXPECT_NEAR(bridge.at(u * T)(0), cubic, 1e-9);
    EXPECT_NEAR(bridge.at(u * T)(1), slope, 1e-8);
  }
}

/// By brute force: the joint normal distribution of all states on a grid, conditioned on both ends.
TEST(Bridge, EqualsConditionedJointDistribution) {
  const WhiteAcceleration motion{.noise = 1.7};
  const std::vector<double> times{0, 0.2, 0.5, 0.6, 1.1};
  const auto n = static_cast<Eigen::Index>(2 * times.size());
  // States in terms of the first state and of the noise of each step.
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  covariance.topLeftCorner(2, 2) = 100 * Eigen::MatrixXd::Identity(2, 2);
  for (Eigen::Index k = 1; k < n / 2; ++k) {
    const auto step = motion.over(times[static_cast<std::size_t>(k)] - times[static_cast<std::size_t>(k) - 1]);
    covariance.block(2 * k, 0, 2, 2 * k) = step.F * covariance.block(2 * k - 2, 0, 2, 2 * k);
    covariance.block(0, 2 * k, 2 * k, 2) = covariance.block(2 * k, 0, 2, 2 * k).transpose();
    covariance.block(2 * k, 2 * k, 2, 2) = step.F * covariance.block(2 * k - 2, 2 * k - 2, 2, 2) * step.F.transpose() + step.Q;
  }
  const Vector<2> before(1, 0.5), after(2, -3);
  Eigen::MatrixXd ends(4, 4);
  ends << covariance.topLeftCorner(2, 2), covariance.topRightCorner(2, 2), covariance.bottomLeftCorner(2, 2),
      covariance.bottomRightCorner(2, 2);
  const Bridge<WhiteAcceleration, 1> bridge(before, times.front(), after, times.back(), motion);
  for (Eigen::Index k = 1; k + 1 < n / 2; ++k) {
    Eigen::MatrixXd across(2, 4);
    across << covariance.block(2 * k, 0, 2, 2), covariance.block(2 * k, n - 2, 2, 2);
    const Eigen::MatrixXd gain = ends.ldlt().solve(across.transpose()).transpose();
    const Eigen::VectorXd mean = gain * (Eigen::VectorXd(4) << before, after).finished();
    const Eigen::MatrixXd spread = covariance.block(2 * k, 2 * k, 2, 2) - gain * across.transpose();
    EXPECT_TRUE(bridge.at(times[static_cast<std::size_t>(k)]).isApprox(mean, 1e-7));
    EXPECT_TRUE(bridge.covariance(times[static_cast<std::size_t>(k)]).isApprox(spread, 1e-6));
  }
}

}  // namespace
}  // namespace marey::filter
