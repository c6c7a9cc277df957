#include "marey/solve/bodies/pose_fit.h"

#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "marey/solve/bodies/moving_bodies_test.h"

namespace marey::solve::bodies {
namespace {

const std::vector<Vector<3>> kPositions = {{0.1, 0, 0}, {-0.1, 0.05, 0}, {0, -0.08, 0.12}, {0.02, 0.1, 0.2}, {0.3, 0.1, 0.1}};

Vector<6> difference(const Rigid3& is, const Rigid3& truth) {
  Vector<6> d;
  d << geometry::angle_axis_of(is.rotation * truth.rotation.transpose()), is.translation - truth.translation;
  return d;
}

TEST(PoseFit, ScattersAsItsCovarianceSays) {
  moving::Random random(3);
  const Rigid3 truth{geometry::rotation_from({0.4, -1, 0.3}), {1, 2, 3}};
  const double sigma = 0.0005;
  Matrix<6> scatter = Matrix<6>::Zero();
  Matrix<6> covariance;
  const int trials = 4000;
  double squares = 0;
  for (int i = 0; i < trials; ++i) {
    std::vector<Vector<3>> detected;
    for (const Vector<3>& location : kPositions) detected.push_back(truth * location + random.gaussian(sigma));
    const auto fit = fit_pose(kPositions, detected, sigma);
    ASSERT_TRUE(fit);
    const Vector<6> error = difference(fit->world_from_body, truth);
    scatter += error * error.transpose() / trials;
    covariance = fit->covariance;
    squares += fit->sum_of_squares / trials;
  }
  EXPECT_NEAR((covariance.inverse() * scatter).trace() / 6, 1, 0.05);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(scatter(i, i) / covariance(i, i), 1, 0.1) << i;
  EXPECT_NEAR(squares / (sigma * sigma * (3 * 5 - 6)), 1, 0.05) << "six degrees of freedom are used up";
}

TEST(PoseFit, NoneInALineOrForTwo) {
  const std::vector<Vector<3>> line = {{0, 0, 0}, {0.1, 0, 0}, {0.25, 0, 0}};
  EXPECT_FALSE(fit_pose(line, line, 0.001));
  EXPECT_FALSE(fit_pose(std::span(kPositions).first(2), std::span(kPositions).first(2), 0.001));
}

TEST(PoseFit, CorrectedByFewMarkersItKnowsWhatItDoesNotKnow) {
  moving::Random random(5);
  const double turn = 0.05, location = 0.01, sigma = 0.0005;
  const Rigid3 truth{geometry::rotation_from({0.4, -1, 0.3}), {1, 2, 3}};
  for (const std::size_t markers : {std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
    double statistic = 0;
    const int trials = 2000;
    for (int i = 0; i < trials; ++i) {
      const Rigid3 belief{geometry::rotation_from(random.gaussian(turn)) * truth.rotation,
                          truth.translation + random.gaussian(location)};
      std::vector<Vector<3>> detected;
      for (std::size_t m = 0; m < markers; ++m) detected.push_back(truth * kPositions[m] + random.gaussian(sigma));
      const PoseFit fit =
          correct_pose({belief, turn * turn, location * location}, std::span(kPositions).first(markers), detected, sigma);
      const Vector<6> error = difference(fit.world_from_body, truth);
      statistic += error.dot(fit.covariance.inverse() * error) / trials;
    }
    EXPECT_NEAR(statistic, 6, 0.8) << markers << " markers";
  }
}

}  // namespace
}  // namespace marey::solve::bodies
