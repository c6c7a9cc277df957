#include "marey/reconstruct/keypoints/trajectory.h"

#include <cmath>
#include <random>

#include <Eigen/Cholesky>
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

Vector<3> place_at(std::size_t instant) {
  const double t = static_cast<double>(instant) / 50;
  return {0.5 * std::sin(2 * t), 0.4 * std::cos(1.7 * t), 1 + 0.1 * std::sin(4 * t)};
}

struct SeenPoint {
  PointLines lines;
  std::vector<std::optional<Vector<3>>> start;

  SeenPoint(std::size_t instants, double sigma, double outliers, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::bernoulli_distribution is_outlier(outliers);
    for (std::size_t i = 0; i < instants; ++i) {
      for (int c = 0; c < 3; ++c) {
        const bool outlier = is_outlier(random);
        const double spread = outlier ? 100 : sigma;
        const Vector<2> pixel =
            *three_cameras()[static_cast<std::size_t>(c)].project(place_at(i)) + spread * Vector<2>(normal(random), normal(random));
        lines.add(*sight_line(three_cameras()[static_cast<std::size_t>(c)], c, pixel, std::max(sigma, 0.5)));
      }
      lines.end_instant();
      start.emplace_back(place_at(i) + Vector<3>(0.02, -0.02, 0.03));
    }
  }
};

TEST(Trajectory, FollowsExactLines) {
  const SeenPoint seen(60, 0, 0, 1);
  const auto path = smooth_trajectory(seen.lines, seen.start, 0.02);
  ASSERT_EQ(path.size(), 60U);
  for (std::size_t i = 0; i < path.size(); ++i) {
    EXPECT_LT((path[i].position - place_at(i)).norm(), 2e-3);
    EXPECT_EQ(path[i].rays, 3);
    EXPECT_EQ(path[i].cameras, 7U);
  }
}

TEST(Trajectory, StatesItsDeviationAndDoesNotMindOutliers) {
  double squares = 0, count = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SeenPoint seen(100, 8, 0.05, seed);
    const auto path = smooth_trajectory(seen.lines, seen.start, 0.02, {.agility_m2_s3 = 4});
    for (std::size_t i = 10; i < 90; ++i) {
      const Vector<3> error = path[i].position - place_at(i);
      squares += error.dot(path[i].covariance.llt().solve(error)) / 3;
      ++count;
      EXPECT_LT(error.norm(), 0.08);
    }
  }
  EXPECT_NEAR(squares / count, 0.8, 0.5) << "near 1: the prior is no sine's";
}

TEST(Trajectory, IsEmptyWhereNothingIsKnown) {
  const SeenPoint seen(5, 0, 0, 1);
  EXPECT_TRUE(smooth_trajectory(seen.lines, std::vector<std::optional<Vector<3>>>(5), 0.02).empty());
}

}  // namespace
}  // namespace marey::reconstruct::keypoints
