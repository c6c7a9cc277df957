#include "marey/source/stabilise/scene_motion.h"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace marey::source::stabilise {
namespace {

const PinholeView kView{.focal = 900, .principal = {319.5, 179.5}};

std::vector<TrackedPosition> locations(const SceneMotion& motion, int count, double noise, double walking, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal(0, noise);
  const Matrix<3> moved = moved_from_rest(motion, kView);
  std::vector<TrackedPosition> all;
  for (int i = 0; i < count; ++i) {
    const Vector<2> rest(640 * unit(random), 360 * unit(random));
    Vector<2> detected = (moved * rest.homogeneous()).hnormalized() + Vector<2>(normal(random), normal(random));
    if (unit(random) < walking) detected += Vector<2>(6, -1);  // a crowd that walks in one direction
    all.push_back({rest, detected});
  }
  return all;
}

TEST(SceneMotion, IsThatOfMostPlacesThoughACrowdWalksAnotherWay) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, 1);
    const SceneMotion truth{0.01 * Vector<3>(normal(random), normal(random), normal(random)), 0.0005 * normal(random)};
    const auto fit = fit_motion(locations(truth, 150, 0.1, 0.35, random), kView, 0.7);
    ASSERT_TRUE(fit);
    const Matrix<3> is = moved_from_rest(truth, kView), found = moved_from_rest(fit->motion, kView);
    for (const Vector<2>& corner : {Vector<2>(0, 0), Vector<2>(639, 0), Vector<2>(0, 359), Vector<2>(639, 359)})
      EXPECT_LT(((is * corner.homogeneous()).hnormalized() - (found * corner.homogeneous()).hnormalized()).norm(), 0.15);
    EXPECT_GT(fit->agreeing, 80);
  }
}

TEST(SceneMotion, AgainstARestThatItselfHasMoved) {
  const SceneMotion rest{{0.01, -0.02, 0.005}, 0}, motion{{0.02, 0.01, -0.01}, 0.001};
  const Matrix<3> both = moved_from_rest(against(motion, rest), kView) * moved_from_rest(rest, kView);
  EXPECT_LT((both / both(2, 2) - moved_from_rest(motion, kView) / moved_from_rest(motion, kView)(2, 2)).norm(), 1e-6);
}

TEST(SceneMotion, OfThreePlacesIsNotKnown) {
  std::mt19937 random(1);
  EXPECT_FALSE(fit_motion(locations({}, 3, 0.1, 0, random), kView, 0.7));
}

}  // namespace
}  // namespace marey::source::stabilise
