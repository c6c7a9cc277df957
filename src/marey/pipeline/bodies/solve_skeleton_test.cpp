// Against models whose true angles are known: OpenSim's own test of inverse kinematics, and Arnold's three walking men.
#include "marey/pipeline/bodies/solve_skeleton.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/skeleton/motion_table.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::pipeline::bodies {
namespace {

namespace fs = std::filesystem;

constexpr double kDegrees = 180 / std::numbers::pi;

/// How far the coordinates are from the truth, degrees; angles only, those that move by themselves and that the table has.
struct AngleErrors {
  double worst = 0, median = 0;
  std::map<std::string, double> worst_of;
};

AngleErrors angle_errors(const SolvedRecording& solved, const SkeletonMotion& truth, const format::skeleton::MotionTable& table) {
  AngleErrors errors;
  std::vector<double> all;
  for (std::size_t r = 0; r < std::min(truth.rows.size(), solved.motion.rows.size()); ++r) {
    for (const std::string& column : table.columns) {
      const auto c = solved.skeleton.coordinate(column);
      if (!c) continue;
      const Coordinate& coordinate = solved.skeleton.coordinates[static_cast<std::size_t>(*c)];
      if (!coordinate.free() || !coordinate.is_rotation) continue;
      const double off =
          std::abs(solved.motion.rows[r][static_cast<std::size_t>(*c)] - truth.rows[r][static_cast<std::size_t>(*c)]) * kDegrees;
      all.push_back(off);
      errors.worst = std::max(errors.worst, off);
      errors.worst_of[column] = std::max(errors.worst_of[column], off);
    }
  }
  std::sort(all.begin(), all.end());
  if (!all.empty()) errors.median = all[all.size() / 2];
  return errors;
}

TEST(SolveSkeleton, FindsTheAnglesOfOpenSimsOwnTest) {
  const std::string folder = test::data("opensim_ik/synthetic/");
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not here";
  const auto model = format::skeleton::read_skeleton(folder + "subject01_simbody.osim");
  SolveOptions options;
  options.up = format::UpAxis::y;
  const SolvedRecording solved = solve_recording(folder + "subject01_synthetic_marker_data.trc", model, options);
  const auto table = format::skeleton::read_motion_table(folder + "std_subject01_walk1_ik.mot");
  const AngleErrors errors = angle_errors(solved, format::skeleton::motion_of(table, solved.skeleton, true), table);
  EXPECT_EQ(solved.summary.frames, 73);
  RecordProperty("worst_degrees", std::to_string(errors.worst));
  std::printf("worst %.4f deg, median %.4f deg, rms %.4f mm\n", errors.worst, errors.median, 1000 * solved.summary.rms_m);
  EXPECT_LT(errors.worst, 0.05);
  EXPECT_LT(solved.summary.rms_m, 0.00005);
}

TEST(SolveSkeleton, FindsTheAnglesOfThreeWalkingMen) {
  const std::string folder = test::data("arnold_synthetic/");
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not here";
  for (const char* subject : {"subject01", "subject02", "subject04"}) {
    SCOPED_TRACE(subject);
    const std::string own = folder + subject + "/";
    const auto model = format::skeleton::read_skeleton(own + "scaled.osim");
    SolveOptions options;
    options.up = format::UpAxis::y;
    for (const char side : {'R', 'L'}) {
      for (const char* joint : {"HJC", "KJC", "AJC", "SJC", "EJC"}) options.exclude.push_back(side + std::string(joint));
    }
    const SolvedRecording solved = solve_recording(own + "markers.trc", model, options);
    const auto table = format::skeleton::read_motion_table(own + "coordinates.sto");
    const AngleErrors errors = angle_errors(solved, format::skeleton::motion_of(table, solved.skeleton, false), table);
    std::printf("%s: worst %.4f deg, median %.5f deg, rms %.4f mm\n", subject, errors.worst, errors.median,
                1000 * solved.summary.rms_m);
    for (const auto& [name, off] : errors.worst_of) {
      if (off > 0.05) std::printf("  %s %.4f\n", name.c_str(), off);
    }
    EXPECT_LT(errors.median, 0.25);
    EXPECT_LT(solved.summary.rms_m, 0.0006);
  }
}

/// OpenSim's own answer for its running man, markers as its model has them.
TEST(SolveSkeleton, PutsMarkersWhereOpenSimDoes) {
  const std::string folder = test::data("opensim_models/hamner/reference/");
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not here";
  const auto model = format::skeleton::read_skeleton(folder + "subject02_registered.osim");
  const auto angles = format::skeleton::read_motion_table(folder + "subject02_running_ik.mot");
  const auto locations = format::skeleton::read_motion_table(folder + "ik_model_marker_locations.sto");
  const SkeletonMotion motion = format::skeleton::motion_of(angles, model.skeleton, true);
  const Matrix<3> up = format::skeleton::z_up_from(format::UpAxis::y);
  double worst = 0;
  std::size_t compared = 0;
  for (std::size_t r = 0; r < std::min(motion.rows.size(), locations.rows.size()); r += 10) {
    std::vector<double> row = motion.rows[r];
    model.skeleton.couple(row);
    const auto pose = pose_of(model.skeleton, row);
    for (const SkeletonMarker& marker : model.skeleton.markers) {
      const auto column = std::find(locations.columns.begin(), locations.columns.end(), marker.label + "_tx");
      if (column == locations.columns.end()) continue;
      const auto c = static_cast<std::size_t>(column - locations.columns.begin());
      const Vector<3> there = up * Vector<3>(*locations.rows[r][c], *locations.rows[r][c + 1], *locations.rows[r][c + 2]);
      worst = std::max(worst, (pose[static_cast<std::size_t>(marker.segment)] * marker.position - there).norm());
      ++compared;
    }
  }
  ASSERT_GT(compared, 1000U);
  EXPECT_LT(worst, 1e-5);
}

/// Sizes, markers' places and poses at once, from the generic model: nimblephysics' own test allows 10 mm, 20 mm and 2.9 degrees.
TEST(SolveSkeleton, CalibratesAGenericModelToThreeMen) {
  const std::string folder = test::data("arnold_synthetic/");
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not here";
  for (const char* subject : {"subject01", "subject02", "subject04"}) {
    SCOPED_TRACE(subject);
    const std::string own = folder + subject + "/";
    SolveOptions options;
    options.up = format::UpAxis::y;
    options.calibrate = true;
    for (const char side : {'R', 'L'}) {
      for (const char* joint : {"HJC", "KJC", "AJC", "SJC", "EJC"}) options.exclude.push_back(side + std::string(joint));
    }
    const SolvedRecording solved = solve_with_skeleton(own + "markers.trc", folder + "unscaled_generic.osim", options);
    const auto truth = format::skeleton::read_skeleton(own + "scaled.osim");
    const auto table = format::skeleton::read_motion_table(own + "coordinates.sto");
    const SkeletonMotion motion = format::skeleton::motion_of(table, truth.skeleton, false);
    double joints = 0, angles = 0;
    int joint_count = 0, angle_count = 0;
    for (std::size_t r = 0; r < solved.motion.rows.size(); r += 10) {
      std::vector<double> row = motion.rows[r];
      truth.skeleton.couple(row);
      const auto there = pose_of(truth.skeleton, row), here = pose_of(solved.skeleton, solved.motion.rows[r]);
      for (std::size_t s = 0; s < there.size(); ++s) {
        const auto same = solved.skeleton.segment(truth.skeleton.segments[s].name);
        if (!same || truth.skeleton.segments[s].name.starts_with("patella")) continue;
        joints += (there[s].translation - here[static_cast<std::size_t>(*same)].translation).norm();
        ++joint_count;
      }
      for (std::size_t c = 0; c < row.size(); ++c) {
        const auto same = solved.skeleton.coordinate(truth.skeleton.coordinates[c].name);
        if (!same || !truth.skeleton.coordinates[c].is_rotation || !truth.skeleton.coordinates[c].free()) continue;
        angles += std::abs(row[c] - solved.motion.rows[r][static_cast<std::size_t>(*same)]) * kDegrees;
        ++angle_count;
      }
    }
    std::printf("%s: scale %.3f, markers %.2f mm, joint centres %.2f mm, angles %.2f deg\n", subject, *solved.summary.overall_scale,
                1000 * solved.summary.rms_m, 1000 * joints / joint_count, angles / angle_count);
    EXPECT_LT(solved.summary.rms_m, 0.010);
    EXPECT_LT(joints / joint_count, 0.020);
    EXPECT_LT(angles / angle_count, 2.9);
  }
}

/// A third of the markers hidden for half a second, in every sixth frame of the beginning: no coordinate jumps, and all is right
/// soon after.
TEST(SolveSkeleton, BearsHiddenMarkers) {
  const std::string own = test::data("arnold_synthetic/subject01/");
  if (!fs::exists(own)) GTEST_SKIP() << own << " is not here";
  const auto model = format::skeleton::read_skeleton(own + "scaled.osim");
  const auto table = format::skeleton::read_motion_table(own + "coordinates.sto");
  const SkeletonMotion truth = format::skeleton::motion_of(table, model.skeleton, false);
  solve::skeleton::PoseSolver solver(model.skeleton);
  double worst_jump = 0, worst_after = 0;
  std::vector<double> before;
  for (std::size_t r = 0; r < truth.rows.size(); ++r) {
    std::vector<double> row = truth.rows[r];
    model.skeleton.couple(row);
    const auto pose = pose_of(model.skeleton, row);
    std::vector<std::optional<Vector<3>>> detected;
    for (std::size_t j = 0; j < model.skeleton.markers.size(); ++j) {
      const SkeletonMarker& marker = model.skeleton.markers[j];
      const bool hidden = marker.label.ends_with("JC") || (r >= 60 && r < 160 && (j * 2654435761U >> 8) % 10 < 3);
      detected.push_back(hidden ? std::nullopt
                                : std::optional<Vector<3>>(pose[static_cast<std::size_t>(marker.segment)] * marker.position));
    }
    const std::vector<double> found = solver.step(1 / 200.0, detected).coordinates;
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (!model.skeleton.coordinates[c].is_rotation || !model.skeleton.coordinates[c].free()) continue;
      if (r > 0) worst_jump = std::max(worst_jump, std::abs(found[c] - before[c]) * kDegrees);
      if (r >= 180) worst_after = std::max(worst_after, std::abs(found[c] - row[c]) * kDegrees);
    }
    before = found;
  }
  std::printf("hidden: worst step between frames %.2f deg, worst error from 0.1 s after %.4f deg\n", worst_jump, worst_after);
  EXPECT_LT(worst_jump, 10);
  EXPECT_LT(worst_after, 0.05);
}

/// A child from its static trial: the human skeleton with Plug-in Gait's markers.
TEST(SolveSkeleton, MakesAPersonsSkeletonOfAStaticTrial) {
  const std::string own = test::data("gait_children/HC002D/");
  if (!fs::exists(own)) GTEST_SKIP() << own << " is not here";
  const test::TemporaryFolder here;
  SolveOptions options;
  options.static_trial = own + "static_HC002D02.c3d";
  options.write_skeleton = here / "child.toml";
  const SolveSummary summary = solve_skeleton(own + "straight_HC002D06.c3d", "", {here / "walk.bvh", here / "walk.mot"}, options);
  std::printf("child: markers %.1f mm RMS\n", 1000 * summary.rms_m);
  EXPECT_LT(summary.rms_m, 0.015);
  EXPECT_EQ(summary.starts, 1);
  EXPECT_EQ(format::skeleton::read_skeleton(here / "child.toml").skeleton.markers.size(), summary.markers.size());
  EXPECT_EQ(format::skeleton::read_skeleton(here / "walk.bvh").motion->rows.size(), 255U);
  options.static_trial = own + "straight_HC002D06.c3d";
  EXPECT_THROW(solve_skeleton(own + "straight_HC002D06.c3d", "", {here / "walk.bvh"}, options), Error)
      << "who walks does not stand still";
}

TEST(SolveSkeleton, SaysWhatItLacks) {
  const std::string folder = test::data("opensim_ik/synthetic/");
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not here";
  const test::TemporaryFolder here;
  test::write_file(here / "skeleton.toml",
                   "[[segment]]\nname = \"hips\"\n[[marker]]\nname = \"SACR\"\non = \"hips\"\nat = [0, 0, 0]\n");
  try {
    solve_skeleton(folder + "subject01_synthetic_marker_data.trc", here / "skeleton.toml", {here / "out.mot"}, {});
    ADD_FAILURE() << "none of the labels is known";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("none of its labels"), std::string::npos) << error.what();
  }
  EXPECT_FALSE(fs::exists(here / "out.mot"));
  EXPECT_THROW(check_skeleton_output("walk.png"), Error);
}

}  // namespace
}  // namespace marey::pipeline::bodies
