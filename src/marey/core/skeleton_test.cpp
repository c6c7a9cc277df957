#include "marey/core/skeleton.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace marey {
namespace {

double between(std::mt19937& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
}

TEST(CoordinateFunction, ASplineIsTheCubicThatItsPointsLieOn) {
  const auto cubic = [](double x) { return 1 - 2 * x + 0.5 * x * x - 0.3 * x * x * x; };
  const std::vector<double> x = {-2, -1.2, 0.1, 0.9, 2, 3};
  std::vector<double> y;
  for (const double at : x) y.push_back(cubic(at));
  const CoordinateFunction spline = CoordinateFunction::spline(x, y);
  for (double at = -2; at <= 3; at += 0.05) {
    EXPECT_NEAR(spline.value(at), cubic(at), 1e-12) << at;
    EXPECT_NEAR(spline.slope(at), -2 + at - 0.9 * at * at, 1e-11) << at;
  }
  EXPECT_NEAR(spline.value(5), cubic(3) + 2 * (-2 + 3 - 8.1), 1e-11) << "straight beyond its end";
}

TEST(CoordinateFunction, SlopesAreThoseOfTheValues) {
  for (const CoordinateFunction& f :
       {CoordinateFunction(), CoordinateFunction::linear(-2, 3), CoordinateFunction::polynomial({1, 2, 3, 4}),
        CoordinateFunction::spline({0, 1, 2.5, 3, 4}, {0, 2, -1, 0, 5}).times(-1.5)}) {
    for (double x = -1; x < 5; x += 0.37) EXPECT_NEAR(f.slope(x), (f.value(x + 1e-6) - f.value(x - 1e-6)) / 2e-6, 1e-6);
  }
}

TEST(TurnsAbout, GiveTheRotationBackInAnyOrderAndHand) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  for (int round = 0; round < 500; ++round) {
    Matrix<3> axes = geometry::rotation_from({between(random, -2, 2), between(random, -2, 2), between(random, -2, 2)});
    if (round % 2 == 0) axes.col(2) *= -1;
    Vector<3> angles(between(random, -6, 6), between(random, -3, 3), between(random, -6, 6));
    if (round % 10 == 0) angles[1] = std::acos(-1.0) / 2;
    const auto rotation = [&](const Vector<3>& by) {
      Matrix<3> r = Matrix<3>::Identity();
      for (int i = 0; i < 3; ++i) r = r * Eigen::AngleAxisd(by[i], axes.col(i)).toRotationMatrix();
      return r;
    };
    const Vector<3> found = rotations_about(rotation(angles), axes, angles);
    EXPECT_LT((rotation(found) - rotation(angles)).norm(), 1e-7);
    if (round % 10 != 0 && std::abs(std::cos(angles[1])) > 1e-3) {
      EXPECT_LT((found - angles).norm(), 1e-7) << "the triple that is nearest is itself";
    }
  }
}

/// Two hinges; the second follows the first.
Skeleton arm() {
  Skeleton skeleton;
  skeleton.name = "arm";
  skeleton.coordinates = {{"shoulder", true, 0.5, {}, {}, false, {}},
                          {"elbow", true, 0, {}, {}, false, Coordinate::Coupling{0, CoordinateFunction::linear(2, 0)}}};
  Segment upper{.name = "upper", .parent = {}, .joint = {{}, {{true, Vector<3>::UnitZ(), {}, 0}}, {}}, .end = {}};
  Segment fore{.name = "fore",
               .parent = 0,
               .joint = {{Matrix<3>::Identity(), {0.3, 0, 0}}, {{true, Vector<3>::UnitZ(), {}, 1}}, {}},
               .end = Vector<3>(0.2, 0, 0)};
  skeleton.segments = {upper, fore};
  skeleton.markers = {{"wrist", 1, {0.2, 0, 0}, 1}};
  return skeleton;
}

TEST(Skeleton, RestsAndFollows) {
  const Skeleton skeleton = arm();
  const std::vector<double> rest = skeleton.rest();
  EXPECT_DOUBLE_EQ(rest[1], 1);
  const auto pose = pose_of(skeleton, rest);
  const Vector<3> wrist = pose[1] * skeleton.markers[0].position;
  EXPECT_NEAR(wrist.x(), 0.3 * std::cos(0.5) + 0.2 * std::cos(1.5), 1e-12);
  EXPECT_EQ(kind_of(skeleton, skeleton.segments[0].joint), "hinge");
}

TEST(Skeleton, ItsBodiesAreParallelAtRest) {
  const Skeleton skeleton = arm();
  const std::vector<Body> bodies = bodies_of(skeleton);
  const auto rest = rest_of(skeleton);
  const auto pose = pose_of(skeleton, skeleton.rest());
  for (std::size_t i = 0; i < bodies.size(); ++i) EXPECT_TRUE(body_pose(pose[i], rest[i]).rotation.isIdentity(1e-12));
  EXPECT_LT((pose[0] * Vector<3>(0.3, 0, 0) - pose[0].translation - bodies[1].offset).norm(), 1e-12);
  EXPECT_EQ(bodies[1].markers.at(0).label, "wrist");
  EXPECT_LT((body_pose(pose[1], rest[1]) * bodies[1].markers[0].position - pose[1] * Vector<3>(0.2, 0, 0)).norm(), 1e-12);
}

}  // namespace
}  // namespace marey
