#include "marey/reconstruct/keypoints/trajectory.h"

#include <cmath>
#include <random>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace marey::reconstruct::keypoints {
namespace {

Camera camera_at(const Vector<3>& centre) {
  const Vector<3> ahead = (Vector<3>(0, 0, 1) - centre).normalized(), right = ahead.cross(Vector<3>::UnitZ()).normalized();
  Rigid3 pose;
  pose.rotation << right.transpose(), ahead.cross(right).transpose(), ahead.transpose();
  pose.translation = -(pose.rotation * centre);
  geometry::BrownLens lens;
  lens.focal = {1500, 1500};
  lens.principal = {540, 960};
  return {lens, pose, {1080, 1920}};
}

const std::vector<Camera>& three_cameras() {
  static const std::vector<Camera> cameras{camera_at({5, 0, 1.5}), camera_at({-2, 4, 1.5}), camera_at({-2, -4, 2})};
  return cameras;
}

Vector<3> position_at(std::size_t instant) {
  const double t = static_cast<double>(instant) / 50;
  return {0.5 * std::sin(2 * t), 0.4 * std::cos(1.7 * t), 1 + 0.1 * std::sin(4 * t)};
}

struct ImageObservation {
  PointLines lines;
  std::vector<std::optional<Vector<3>>> start;

  ImageObservation(std::size_t instants, double sigma, double outliers, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::bernoulli_distribution is_outlier(outliers);
    for (std::size_t i = 0; i < instants; ++i) {
      for (int c = 0; c < 3; ++c) {
        const bool outlier = is_outlier(random);
        const double spread = outlier ? 100 : sigma;
        const Vector<2> pixel = *three_cameras()[static_cast<std::size_t>(c)].project(position_at(i)) +
                                spread * Vector<2>(normal(random), normal(random));
        lines.add(*sight_line(three_cameras()[static_cast<std::size_t>(c)], c, pixel, std::max(sigma, 0.5)));
      }
      lines.end_instant();
      start.emplace_back(position_at(i) + Vector<3>(0.02, -0.02, 0.03));
    }
  }
};

TEST(Trajectory, FollowsExactLines) {
  const ImageObservation detected(60, 0, 0, 1);
  const auto path = smooth_trajectory(detected.lines, detected.start, 0.02);
  ASSERT_EQ(path.size(), 60U);
  for (std::size_t i = 0; i < path.size(); ++i) {
    EXPECT_LT((path[i].position - position_at(i)).norm(), 2e-3);
    EXPECT_EQ(path[i].rays, 3);
    EXPECT_EQ(path[i].cameras, 7U);
  }
}

TEST(Trajectory, StatesItsDeviationAndDoesNotMindOutliers) {
  double squares = 0, count = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const ImageObservation detected(100, 8, 0.05, seed);
    const auto path = smooth_trajectory(detected.lines, detected.start, 0.02, {.agility_m2_s3 = 4});
    for (std::size_t i = 10; i < 90; ++i) {
      const Vector<3> error = path[i].position - position_at(i);
      squares += error.dot(path[i].covariance.llt().solve(error)) / 3;
      ++count;
      EXPECT_LT(error.norm(), 0.08);
    }
  }
  EXPECT_NEAR(squares / count, 0.8, 0.5) << "near 1: the prior is not a sine's";
}

/// The same problem as one dense system, solved by Gauss and Newton's method: all places and velocities at once.
struct DensePath {
  Eigen::VectorXd states;
  Eigen::MatrixXd covariance;
};
DensePath dense_path(const ImageObservation& detected, double step, double agility, double anywhere) {
  const auto count = static_cast<Eigen::Index>(detected.lines.instants());
  Matrix<6> F = Matrix<6>::Identity(), Q = Matrix<6>::Zero();
  F.topRightCorner<3, 3>() = step * Matrix<3>::Identity();
  Q.topLeftCorner<3, 3>() = agility * step * step * step / 3 * Matrix<3>::Identity();
  Q.topRightCorner<3, 3>() = Q.bottomLeftCorner<3, 3>() = agility * step * step / 2 * Matrix<3>::Identity();
  Q.bottomRightCorner<3, 3>() = agility * step * Matrix<3>::Identity();
  const Matrix<6> W = Q.inverse();
  DensePath path{Eigen::VectorXd::Zero(6 * count), {}};
  for (Eigen::Index t = 0; t < count; ++t) path.states.segment<3>(6 * t) = *detected.start[static_cast<std::size_t>(t)];
  for (int round = 0; round < 30; ++round) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(6 * count, 6 * count);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(6 * count);
    A.topLeftCorner<6, 6>() += Matrix<6>::Identity() / (anywhere * anywhere);
    g.head<6>() +=
        (path.states.head<6>() - (Vector<6>() << path.states.head<3>(), Vector<3>::Zero()).finished()) / (anywhere * anywhere);
    for (Eigen::Index t = 0; t < count; ++t) {
      const Vector<3> at = path.states.segment<3>(6 * t);
      for (const SightLine& line : detected.lines.at(static_cast<std::size_t>(t))) {
        const Vector<2> error = line.error(at) / line.sigma;
        const Eigen::Matrix<double, 2, 3> J = (line.across / line.sigma - error * line.direction.transpose()) / line.depth(at);
        A.block<3, 3>(6 * t, 6 * t) += J.transpose() * J;
        g.segment<3>(6 * t) += J.transpose() * error;
      }
      if (t + 1 == count) continue;
      Eigen::Matrix<double, 6, 12> D;
      D << -F, Matrix<6>::Identity();
      A.block<12, 12>(6 * t, 6 * t) += D.transpose() * W * D;
      g.segment<12>(6 * t) += D.transpose() * W * (path.states.segment<6>(6 * t + 6) - F * path.states.segment<6>(6 * t));
    }
    path.states -= A.ldlt().solve(g);
    path.covariance = A.inverse();
  }
  return path;
}

TEST(Trajectory, AgreesWithOneDenseSystem) {
  const ImageObservation detected(12, 5, 0, 7);
  const double step = 0.02, agility = 4;
  const auto path = smooth_trajectory(detected.lines, detected.start, step, {.agility_m2_s3 = agility, .bound = 1e6, .rounds = 30});
  const DensePath dense = dense_path(detected, step, agility, 5);
  for (std::size_t t = 0; t < path.size(); ++t) {
    const auto at = static_cast<Eigen::Index>(6 * t);
    EXPECT_LT((path[t].position - dense.states.segment<3>(at)).norm(), 1e-5);
    EXPECT_LT((path[t].velocity - dense.states.segment<3>(at + 3)).norm(), 1e-3);
    EXPECT_LT((path[t].covariance - dense.covariance.block<3, 3>(at, at)).norm(), 1e-3 * path[t].covariance.norm());
  }
}

TEST(Trajectory, IsEmptyWhereNothingIsKnown) {
  const ImageObservation detected(5, 0, 0, 1);
  EXPECT_TRUE(smooth_trajectory(detected.lines, std::vector<std::optional<Vector<3>>>(5), 0.02).empty());
}

}  // namespace
}  // namespace marey::reconstruct::keypoints
