#include "marey/solve/skeleton/pose_solver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <span>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/solve/skeleton/whole.h"

namespace marey::solve::skeleton {
namespace {

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
}

Vector<3> anywhere(std::mt19937& random, double size) {
  return {uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)};
}

std::string numbered(std::string stem, std::size_t number) {
  return stem.append(std::to_string(number));
}

/// A joint of this many turns about axes that are perpendicular, or of one that a spline turns and shifts.
void add_segment(Skeleton& skeleton, std::optional<int> parent, int rotations, bool free, std::mt19937& random) {
  Segment segment{.name = numbered("s", skeleton.segments.size()), .parent = parent, .joint = {}, .end = {}};
  segment.joint.parent_from_joint = {geometry::rotation_from(anywhere(random, 1)), anywhere(random, 0.3)};
  segment.joint.joint_from_segment = {geometry::rotation_from(anywhere(random, 1)), anywhere(random, 0.1)};
  const auto coordinate = [&](bool turn) {
    skeleton.coordinates.push_back({numbered("c", skeleton.coordinates.size()), turn, 0, {}, {}, false, {}});
    return static_cast<int>(skeleton.coordinates.size()) - 1;
  };
  for (int i = 0; free && i < 3; ++i) segment.joint.axes.push_back({false, Vector<3>::Unit(i), {}, coordinate(false)});
  const Matrix<3> axes = geometry::rotation_from(anywhere(random, 2));
  if (rotations == 1) {  // a knee: it shifts as it turns
    const int knee = coordinate(true);
    segment.joint.axes.push_back(
        {false, Vector<3>::UnitX(), CoordinateFunction::spline({-2, -1, 0, 1, 2}, {0.03, 0.01, 0, 0.02, 0.05}), knee});
    segment.joint.axes.push_back({true, axes.col(0), {}, knee});
  } else {
    for (int i = 0; i < rotations; ++i) segment.joint.axes.push_back({true, axes.col(i), {}, coordinate(true)});
  }
  const int index = static_cast<int>(skeleton.segments.size());
  skeleton.segments.push_back(std::move(segment));
  for (int i = 0; i < 4; ++i)
    skeleton.markers.push_back({numbered("m", skeleton.markers.size()), index, anywhere(random, 0.15), 1});
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
  std::vector<std::optional<Vector<3>>> locations;
  for (const SkeletonMarker& marker : skeleton.markers)
    locations.emplace_back(pose[static_cast<std::size_t>(marker.segment)] * marker.position);
  return locations;
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
    auto detected = markers_at(skeleton, pose_near_rest(skeleton, random, 1));
    detected[2].reset();
    PoseEquations equations;
    solver.linearise(state, detected, equations);
    const int n = solver.articulation().dofs();
    const auto residuals = [&](const SkeletonState& at) {
      solver.articulation().location(at);
      Eigen::VectorXd r = Eigen::VectorXd::Zero(3 * std::ssize(detected));
      for (std::size_t j = 0; j < detected.size(); ++j) {
        if (detected[j])
          r.segment<3>(3 * static_cast<Eigen::Index>(j)) =
              *detected[j] - solver.articulation().world_from_segment()[static_cast<std::size_t>(skeleton.markers[j].segment)] *
                                 skeleton.markers[j].position;
      }
      return r;
    };
    Eigen::MatrixXd jacobian(3 * std::ssize(detected), n);
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

/// The plain least-squares pose of one frame, from a pose near it.
double least_squares_rms(const Skeleton& skeleton, std::vector<double> near, std::span<const std::optional<Vector<3>>> detected) {
  PoseSolver solver(skeleton, {.marker_sigma_m = 1, .robust_m = 1e6});
  SkeletonState state = solver.articulation().state_of(std::move(near)), moved;
  PoseEquations equations;
  for (int round = 0; round < 30; ++round) {
    solver.linearise(state, detected, equations);
    equations.information.diagonal().array() += 1e-9;
    solver.articulation().move(state, equations.information.ldlt().solve(equations.gradient), moved);
    std::swap(state, moved);
  }
  solver.linearise(state, detected, equations);
  return std::sqrt(equations.cost /
                   static_cast<double>(std::count_if(detected.begin(), detected.end(), [](const auto& m) { return m; })));
}

/// At several rates a body whose markers sit up to 20 mm from where the skeleton has them: as near as the least squares of each
/// frame, and in the end in one pose. All joints at once turn by up to 0.6 rad × `speed`.
void track_at_rates(double speed, std::span<const double> rates) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const Skeleton skeleton = body(random);
  Skeleton person = skeleton;
  for (SkeletonMarker& marker : person.markers) marker.position += anywhere(random, 0.02);
  const std::vector<double> centre = pose_near_rest(skeleton, random, 0.3);
  const auto truth_at = [&](double time) {
    std::vector<double> truth = centre;
    for (std::size_t c = 0; c < truth.size(); ++c)
      truth[c] += (skeleton.coordinates[c].is_rotation ? 0.6 : 0.1) * std::sin(speed * time + static_cast<double>(c));
    truth[0] += 9 * time;
    skeleton.couple(truth);
    return truth;
  };
  std::vector<double> at_the_end;
  for (const double rate : rates) {
    PoseSolver solver(skeleton);
    solver.start_from(truth_at(0));
    double found = 0, minimum = 0;
    const int frames = static_cast<int>(0.4 * rate);
    for (int frame = 0; frame <= frames; ++frame) {
      const std::vector<double> truth = truth_at(frame / rate);
      const auto detected = markers_at(person, truth);
      found += std::pow(solver.step(1 / rate, detected).rms_m, 2);
      minimum += std::pow(least_squares_rms(skeleton, truth, detected), 2);
    }
    EXPECT_LT(std::sqrt(found), 1.1 * std::sqrt(minimum)) << rate << " Hz";
    if (at_the_end.empty()) at_the_end = solver.pose().coordinates;
    for (std::size_t c = 0; c < at_the_end.size(); ++c) {
      if (!skeleton.coordinates[c].is_rotation) continue;
      EXPECT_LT(std::abs(std::remainder(solver.pose().coordinates[c] - at_the_end[c], 2 * std::numbers::pi)),
                0.02 + solver.pose().deviations[c])
          << rate << " Hz";
    }
  }
}

/// A prediction that counted for more the shorter the frames are would win over the markers here.
TEST(PoseSolver, FollowsFastMotionAtAnyRate) {
  track_at_rates(40, std::array{200.0, 500.0, 1000.0});
  track_at_rates(8, std::array{25.0, 50.0, 100.0, 250.0});
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
  auto detected = markers_at(skeleton, truth);
  for (std::size_t j = 0; j < detected.size(); ++j) {
    if (skeleton.markers[j].segment == 3) detected[j].reset();
  }
  for (int i = 0; i < 50; ++i) solver.step(0.01, detected);
  EXPECT_FALSE(solver.pose().observed[static_cast<std::size_t>(hidden_joint)]);
  EXPECT_NEAR(solver.pose().coordinates[static_cast<std::size_t>(hidden_joint)], before, 0.02);
}

TEST(PoseSolver, IsNotDraggedAlongByAWrongLabel) {
  std::mt19937 random(7);
  const Skeleton skeleton = body(random);
  const std::vector<double> truth = pose_near_rest(skeleton, random, 0.3);
  PoseSolver solver(skeleton);
  for (int i = 0; i < 5; ++i) solver.step(0.01, markers_at(skeleton, truth));
  auto detected = markers_at(skeleton, truth);
  *detected[5] += Vector<3>(0.5, 0, 0.3);
  solver.step(0.01, detected);
  for (std::size_t c = 0; c < truth.size(); ++c) {
    if (skeleton.coordinates[c].is_rotation) {
      EXPECT_LT(std::abs(std::remainder(solver.pose().coordinates[c] - truth[c], 2 * std::numbers::pi)), 0.05);
    }
  }
}

/// A trunk, an upper arm that turns freely and a forearm on an elbow that bends to one side, with few markers, as sets have them.
Skeleton arm() {
  Skeleton skeleton;
  skeleton.name = "arm";
  const auto coordinate = [&](bool is_rotation, std::optional<double> lowest, std::optional<double> highest) {
    skeleton.coordinates.push_back({numbered("c", skeleton.coordinates.size()), is_rotation, 0, lowest, highest, false, {}});
    return static_cast<int>(skeleton.coordinates.size()) - 1;
  };
  Segment trunk{.name = "trunk", .parent = {}, .joint = {}, .end = {}};
  for (int i = 0; i < 6; ++i) trunk.joint.axes.push_back({i >= 3, Vector<3>::Unit(i % 3), {}, coordinate(i >= 3, {}, {})});
  Segment upper{.name = "upper arm", .parent = 0, .joint = {}, .end = {}};
  upper.joint.parent_from_joint.translation = {0, 0.2, 0.4};
  for (int i = 0; i < 3; ++i) upper.joint.axes.push_back({true, Vector<3>::Unit(i), {}, coordinate(true, {}, {})});
  Segment fore{.name = "forearm", .parent = 1, .joint = {}, .end = {}};
  fore.joint.parent_from_joint.translation = {0, 0, -0.3};
  fore.joint.axes.push_back({true, -Vector<3>::UnitY(), {}, coordinate(true, -0.26, 2.88)});
  fore.joint.axes.push_back({true, -Vector<3>::UnitZ(), {}, coordinate(true, -3.14, 3.14)});
  skeleton.segments = {trunk, upper, fore};
  for (const Vector<3>& location :
       {Vector<3>(0.1, 0, 0), Vector<3>(-0.1, 0, 0.1), Vector<3>(0, 0.15, 0.4), Vector<3>(0, -0.15, 0.4)})
    skeleton.markers.push_back({"t" + std::to_string(skeleton.markers.size()), 0, location, 1});
  for (const Vector<3>& location : {Vector<3>(0, 0.03, -0.15), Vector<3>(0, 0.03, -0.3)})
    skeleton.markers.push_back({"u" + std::to_string(skeleton.markers.size()), 1, location, 1});
  for (const double side : {0.03, -0.03})
    skeleton.markers.push_back({"f" + std::to_string(skeleton.markers.size()), 2, Vector<3>(0, side, -0.25), 1});
  return skeleton;
}

/// The upper arm turned by half a turn about itself and the elbow as far backwards as it may lie nearly as the bent arm does.
TEST(PoseSolver, TurnsAnArmThatIsBentBackwards) {
  const Skeleton skeleton = arm();
  std::vector<double> truth = skeleton.rest(), wrong;
  truth[9] = 0.6;
  wrong = truth;
  wrong[8] = std::numbers::pi;
  wrong[9] = -0.26;
  wrong[10] = 3.1;
  const auto detected = markers_at(skeleton, truth);
  const auto elbow = [&](double at_limit_s) {
    PoseSolver solver(skeleton, {.at_limit_s = at_limit_s});
    solver.start_from(wrong);
    for (int i = 0; i < 100; ++i) solver.step(0.01, detected);
    return solver.pose().coordinates[9];
  };
  EXPECT_LT(elbow(1e9), 0) << "no trap: the test shows nothing";
  EXPECT_NEAR(elbow(0.25), 0.6, 0.01);
}

/// The same trap over a whole recording, in which the elbow never was at its limit for long enough to be asked.
TEST(PoseSolver, TheRecordingDecidesHowALimbIsBent) {
  const Skeleton skeleton = arm();
  std::vector<std::vector<double>> rows;
  std::vector<std::vector<std::optional<Vector<3>>>> frames;
  PoseSolver solver(skeleton, {.at_limit_s = 1e9});
  for (int f = 0; f < 100; ++f) {
    std::vector<double> truth = skeleton.rest();
    truth[9] = 0.6 + 0.1 * std::sin(0.1 * f);
    frames.push_back(markers_at(skeleton, truth));
    if (f == 0) {
      truth[8] = std::numbers::pi;
      truth[9] = -0.26;
      truth[10] = 3.1;
      solver.start_from(truth);
    }
    rows.push_back(solver.step(0.01, frames.back()).coordinates);
  }
  ASSERT_LT(rows.back()[9], 0) << "no trap: the test shows nothing";
  const std::vector<bool> settled = settle_folds(skeleton, rows, frames, 100, {.at_limit_s = 1e9});
  EXPECT_EQ(std::count(settled.begin(), settled.end(), true), std::ssize(frames));
  for (int f = 0; f < 100; ++f) EXPECT_NEAR(rows[static_cast<std::size_t>(f)][9], 0.6 + 0.1 * std::sin(0.1 * f), 0.01) << f;
}

TEST(PoseSolver, RefusesASkeletonThatCannotBeSolved) {
  std::mt19937 random(1);
  Skeleton skeleton = body(random);
  skeleton.markers.clear();
  EXPECT_THROW(PoseSolver{skeleton}, Error);
}

}  // namespace
}  // namespace marey::solve::skeleton
