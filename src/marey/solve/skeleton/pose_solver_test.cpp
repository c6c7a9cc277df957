#include "marey/solve/skeleton/pose_solver.h"

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::solve::skeleton {
namespace {

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
}

Vector<3> anywhere(std::mt19937& random, double size) {
  return {uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)};
}

/// A joint of so many turns about axes that are perpendicular, or of one that a spline turns and shifts.
void add_segment(Skeleton& skeleton, std::optional<int> parent, int turns, bool free, std::mt19937& random) {
  Segment segment{.name = "s" + std::to_string(skeleton.segments.size()), .parent = parent, .joint = {}, .end = {}};
  segment.joint.parent_from_joint = {geometry::rotation_from(anywhere(random, 1)), anywhere(random, 0.3)};
  segment.joint.joint_from_segment = {geometry::rotation_from(anywhere(random, 1)), anywhere(random, 0.1)};
  const auto coordinate = [&](bool turn) {
    skeleton.coordinates.push_back({"c" + std::to_string(skeleton.coordinates.size()), turn, 0, {}, {}, false, {}});
    return static_cast<int>(skeleton.coordinates.size()) - 1;
  };
  for (int i = 0; free && i < 3; ++i) segment.joint.axes.push_back({false, Vector<3>::Unit(i), {}, coordinate(false)});
  const Matrix<3> axes = geometry::rotation_from(anywhere(random, 2));
  if (turns == 1) {  // a knee: it shifts as it turns
    const int knee = coordinate(true);
    segment.joint.axes.push_back(
        {false, Vector<3>::UnitX(), CoordinateFunction::spline({-2, -1, 0, 1, 2}, {0.03, 0.01, 0, 0.02, 0.05}), knee});
    segment.joint.axes.push_back({true, axes.col(0), {}, knee});
  } else {
    for (int i = 0; i < turns; ++i) segment.joint.axes.push_back({true, axes.col(i), {}, coordinate(true)});
  }
  const int index = static_cast<int>(skeleton.segments.size());
  skeleton.segments.push_back(std::move(segment));
  for (int i = 0; i < 4; ++i)
    skeleton.markers.push_back({"m" + std::to_string(skeleton.markers.size()), index, anywhere(random, 0.15), 1});
}

/// A root, two limbs of ball, hinge and universal joints, and a coordinate that follows another.
Skeleton body(std::mt19937& random) {
  Skeleton skeleton;
  skeleton.name = "body";
  add_segment(skeleton, std::nullopt, 3, true, random);
  for (int limb = 0; limb < 2; ++limb) {
    add_segment(skeleton, 0, 3, false, random);
    const int upper = static_cast<int>(skeleton.segments.size()) - 1;
    add_segment(skeleton, upper, 1, false, random);
    add_segment(skeleton, upper + 1, 2, false, random);
  }
  skeleton.coordinates.back().coupling =
      Coordinate::Coupling{skeleton.segments[3].joint.axes.back().coordinate.value(), CoordinateFunction::linear(0.5, 0.1)};
  return skeleton;
}

std::vector<double> pose_near_rest(const Skeleton& skeleton, std::mt19937& random, double size) {
  std::vector<double> coordinates = skeleton.rest();
  for (double& c : coordinates) c += uniform(random, -size, size);
  skeleton.couple(coordinates);
  return coordinates;
}

std::vector<std::optional<Vector<3>>> markers_at(const Skeleton& skeleton, const std::vector<double>& coordinates) {
  const auto pose = pose_of(skeleton, coordinates);
  std::vector<std::optional<Vector<3>>> places;
  for (const SkeletonMarker& marker : skeleton.markers)
    places.emplace_back(pose[static_cast<std::size_t>(marker.segment)] * marker.position);
  return places;
}

/// The slow twin: markers moved by small steps, J'J and J'r by hand.
TEST(PoseSolver, ItsEquationsAreThoseOfSmallSteps) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  for (int round = 0; round < 20; ++round) {
    const Skeleton skeleton = body(random);
    PoseSolver solver(skeleton, {.marker_sigma_m = 1, .robust_m = 1e6});
    const SkeletonState state = solver.articulation().state_of(pose_near_rest(skeleton, random, 1));
    auto seen = markers_at(skeleton, pose_near_rest(skeleton, random, 1));
    seen[2].reset();
    PoseEquations equations;
    solver.linearise(state, seen, equations);
    const int n = solver.articulation().dofs();
    const auto residuals = [&](const SkeletonState& at) {
      solver.articulation().place(at);
      Eigen::VectorXd r = Eigen::VectorXd::Zero(3 * std::ssize(seen));
      for (std::size_t j = 0; j < seen.size(); ++j) {
        if (seen[j])
          r.segment<3>(3 * static_cast<Eigen::Index>(j)) =
              *seen[j] - solver.articulation().world_from_segment()[static_cast<std::size_t>(skeleton.markers[j].segment)] *
                             skeleton.markers[j].position;
      }
      return r;
    };
    Eigen::MatrixXd jacobian(3 * std::ssize(seen), n);
    for (int d = 0; d < n; ++d) {
      Eigen::VectorXd step = Eigen::VectorXd::Zero(n);
      SkeletonState ahead, back;
      step[d] = 1e-6;
      solver.articulation().move(state, step, ahead);
      solver.articulation().move(state, -step, back);
      jacobian.col(d) = -(residuals(ahead) - residuals(back)) / 2e-6;
    }
    EXPECT_LT((equations.information - jacobian.transpose() * jacobian).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_LT((equations.gradient - jacobian.transpose() * residuals(state)).cwiseAbs().maxCoeff(), 1e-6);
  }
}

TEST(PoseSolver, FindsAMotionFromNothing) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  for (int round = 0; round < 5; ++round) {
    const Skeleton skeleton = body(random);
    const std::vector<double> centre = pose_near_rest(skeleton, random, 0.6);
    PoseSolver solver(skeleton);
    for (int frame = 0; frame < 50; ++frame) {
      std::vector<double> truth = centre;
      for (std::size_t c = 0; c < truth.size(); ++c) truth[c] += 0.3 * std::sin(0.1 * frame + static_cast<double>(c));
      skeleton.couple(truth);
      const SolvedPose& solved = solver.step(0.01, markers_at(skeleton, truth));
      EXPECT_LT(solved.rms_m, 1e-4) << frame;
      if (frame > 10) {
        EXPECT_LT(solved.iterations, 8);
      }
    }
  }
}

TEST(PoseSolver, HoldsWhatNoMarkerShowsAndSaysSo) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const Skeleton skeleton = body(random);
  const std::vector<double> truth = pose_near_rest(skeleton, random, 0.3);
  PoseSolver solver(skeleton);
  for (int i = 0; i < 5; ++i) solver.step(0.01, markers_at(skeleton, truth));
  const int hidden_joint = skeleton.segments[3].joint.axes[0].coordinate.value();  // of the first limb's last segment
  const double before = solver.pose().coordinates[static_cast<std::size_t>(hidden_joint)];
  EXPECT_TRUE(solver.pose().observed[static_cast<std::size_t>(hidden_joint)]);
  auto seen = markers_at(skeleton, truth);
  for (std::size_t j = 0; j < seen.size(); ++j) {
    if (skeleton.markers[j].segment == 3) seen[j].reset();
  }
  for (int i = 0; i < 50; ++i) solver.step(0.01, seen);
  EXPECT_FALSE(solver.pose().observed[static_cast<std::size_t>(hidden_joint)]);
  EXPECT_NEAR(solver.pose().coordinates[static_cast<std::size_t>(hidden_joint)], before, 0.02);
}

TEST(PoseSolver, IsNotDraggedAlongByAWrongLabel) {
  std::mt19937 random(7);
  const Skeleton skeleton = body(random);
  const std::vector<double> truth = pose_near_rest(skeleton, random, 0.3);
  PoseSolver solver(skeleton);
  for (int i = 0; i < 5; ++i) solver.step(0.01, markers_at(skeleton, truth));
  auto seen = markers_at(skeleton, truth);
  *seen[5] += Vector<3>(0.5, 0, 0.3);
  solver.step(0.01, seen);
  for (std::size_t c = 0; c < truth.size(); ++c) {
    if (skeleton.coordinates[c].turns) {
      EXPECT_LT(std::abs(std::remainder(solver.pose().coordinates[c] - truth[c], 2 * std::numbers::pi)), 0.05);
    }
  }
}

TEST(PoseSolver, RefusesASkeletonThatCannotBeSolved) {
  std::mt19937 random(1);
  Skeleton skeleton = body(random);
  skeleton.markers.clear();
  EXPECT_THROW(PoseSolver{skeleton}, Error);
}

}  // namespace
}  // namespace marey::solve::skeleton
