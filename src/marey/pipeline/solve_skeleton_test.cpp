// Against models whose true angles are known: OpenSim's own test of inverse kinematics, and Arnold's three walking men.
#include "marey/pipeline/solve_skeleton.h"

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

namespace marey::pipeline {
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
      if (!coordinate.free() || !coordinate.turns) continue;
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
      for (const char* joint : {"HJC", "KJC", "AJC", "SJC", "EJC"}) options.leave_out.push_back(side + std::string(joint));
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
  const auto places = format::skeleton::read_motion_table(folder + "ik_model_marker_locations.sto");
  const SkeletonMotion motion = format::skeleton::motion_of(angles, model.skeleton, true);
  const Matrix<3> up = format::skeleton::z_up_from(format::UpAxis::y);
  double worst = 0;
  std::size_t compared = 0;
  for (std::size_t r = 0; r < std::min(motion.rows.size(), places.rows.size()); r += 10) {
    std::vector<double> row = motion.rows[r];
    model.skeleton.couple(row);
    const auto pose = pose_of(model.skeleton, row);
    for (const SkeletonMarker& marker : model.skeleton.markers) {
      const auto column = std::find(places.columns.begin(), places.columns.end(), marker.label + "_tx");
      if (column == places.columns.end()) continue;
      const auto c = static_cast<std::size_t>(column - places.columns.begin());
      const Vector<3> there = up * Vector<3>(*places.rows[r][c], *places.rows[r][c + 1], *places.rows[r][c + 2]);
      worst = std::max(worst, (pose[static_cast<std::size_t>(marker.segment)] * marker.position - there).norm());
      ++compared;
    }
  }
  ASSERT_GT(compared, 1000U);
  EXPECT_LT(worst, 1e-5);
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
}  // namespace marey::pipeline
