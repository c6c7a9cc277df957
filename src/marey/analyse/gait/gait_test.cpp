#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "marey/analyse/gait/conventional_model.h"
#include "marey/analyse/gait/gait_cycles.h"
#include "marey/analyse/gait/joint_angles.h"

namespace marey::analyse::gait {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Matrix<3> about(const Vector<3>& axis, double degrees) {
  return Eigen::AngleAxisd(degrees * kDegree, axis).toRotationMatrix();
}

double angle(const GaitPose& pose, const std::string& name) {
  const auto names = angle_names();
  const auto at = std::find(names.begin(), names.end(), name);
  EXPECT_NE(at, names.end()) << name;
  return angles_of(pose, {1, 0})[static_cast<std::size_t>(at - names.begin())].value() / kDegree;
}

TEST(JointAngles, AreSignedAlikeLeftAndRight) {
  GaitPose pose;
  pose[SegmentId::pelvis] = Rigid3{};
  // Thighs ahead by 30°: knees go forward, so that the thigh's upper end leans back.
  for (const Side side : kSides)
    pose[of_side(SegmentId::left_thigh, side)] = Rigid3{about(Vector<3>::UnitY(), -30), Vector<3>::Zero()};
  EXPECT_NEAR(angle(pose, "left_hip_flexion"), 30, 1e-9);
  EXPECT_NEAR(angle(pose, "right_hip_flexion"), 30, 1e-9);
  // Both knees 10° towards the middle: the left one to the right.
  pose[SegmentId::left_thigh]->rotation = about(Vector<3>::UnitX(), -10);
  pose[SegmentId::right_thigh]->rotation = about(Vector<3>::UnitX(), 10);
  EXPECT_NEAR(angle(pose, "left_hip_adduction"), 10, 1e-9);
  EXPECT_NEAR(angle(pose, "right_hip_adduction"), 10, 1e-9);
  // Both toes 15° inwards.
  pose[SegmentId::left_thigh]->rotation = about(Vector<3>::UnitZ(), -15);
  pose[SegmentId::right_thigh]->rotation = about(Vector<3>::UnitZ(), 15);
  EXPECT_NEAR(angle(pose, "left_hip_rotation"), 15, 1e-9);
  EXPECT_NEAR(angle(pose, "right_hip_rotation"), 15, 1e-9);
  // A knee bends backwards, a toe goes up.
  pose[SegmentId::left_shank] = Rigid3{pose[SegmentId::left_thigh]->rotation * about(Vector<3>::UnitY(), 60), Vector<3>::Zero()};
  pose[SegmentId::left_foot] = Rigid3{pose[SegmentId::left_shank]->rotation * about(Vector<3>::UnitY(), -20), Vector<3>::Zero()};
  EXPECT_NEAR(angle(pose, "left_knee_flexion"), 60, 1e-9);
  EXPECT_NEAR(angle(pose, "left_ankle_dorsiflexion"), 20, 1e-9);
}

TEST(JointAngles, ShouldersHavePlaneAndElevation) {
  GaitPose pose;
  pose[SegmentId::trunk] = Rigid3{};
  pose[SegmentId::left_upper_arm] = Rigid3{about(Vector<3>::UnitX(), 80), Vector<3>::Zero()};    // the left arm out to the left
  pose[SegmentId::right_upper_arm] = Rigid3{about(Vector<3>::UnitY(), -70), Vector<3>::Zero()};  // the right arm ahead
  EXPECT_NEAR(angle(pose, "left_shoulder_elevation"), 80, 1e-9);
  EXPECT_NEAR(angle(pose, "left_shoulder_plane"), 0, 1e-9);
  EXPECT_NEAR(angle(pose, "right_shoulder_elevation"), 70, 1e-9);
  EXPECT_NEAR(angle(pose, "right_shoulder_plane"), 90, 1e-9);
}

/// Trunk and left arm that hangs down: the forearm bends by `bend` degrees at the elbow's marker, ahead where the arm is turned
/// outwards by 0°. Palms face the body.
MarkerPositions arm_markers(double bend, double rotated) {
  const Matrix<3> turn = about(Vector<3>::UnitZ(), rotated), forearm = turn * about(Vector<3>::UnitY(), -bend);
  const Vector<3> shoulder(0, 0.17, 1.42), elbow = shoulder + turn * Vector<3>(0, 0.05, -0.28);
  MarkerPositions markers = {{"C7", {-0.07, 0, 1.45}},  {"T10", {-0.1, 0, 1.2}}, {"CLAV", {0.05, 0, 1.4}},
                             {"STRN", {0.08, 0, 1.25}}, {"LSHO", shoulder},      {"LELB", elbow}};
  markers["LWRA"] = elbow + forearm * Vector<3>(0.03, 0, -0.24);
  markers["LWRB"] = elbow + forearm * Vector<3>(-0.03, 0, -0.24);
  markers["LFIN"] = elbow + forearm * Vector<3>(0, 0, -0.31);
  return markers;
}

TEST(JointAngles, AnElbowGoesOnWhereverItsArmTurns) {
  std::optional<double> before, flexion_ahead;
  for (double rotated = 0; rotated >= -150; rotated -= 2) {
    const GaitPose pose = pose_of(arm_markers(30, rotated), {});
    const double flexion = angle(pose, "left_elbow_flexion"), pronation = angle(pose, "left_elbow_pronation");
    EXPECT_GT(flexion, 25) << rotated;
    if (!flexion_ahead) flexion_ahead = flexion;
    EXPECT_NEAR(flexion, *flexion_ahead, 8) << rotated;
    EXPECT_NEAR(pronation, before.value_or(pronation), 3) << rotated;
    before = pronation;
  }
}

TEST(JointAngles, AnElbowGoesOnWhereItIsStraight) {
  std::optional<double> flexion_before, pronation_before;
  for (double bend = 40; bend >= -2; bend -= 0.5) {
    const GaitPose pose = pose_of(arm_markers(bend, -20), {});
    const double flexion = angle(pose, "left_elbow_flexion"), pronation = angle(pose, "left_elbow_pronation");
    if (flexion_before) {
      EXPECT_NEAR(flexion, *flexion_before, 2) << bend;
      EXPECT_NEAR(pronation, *pronation_before, 20) << bend;
    }
    flexion_before = flexion;
    pronation_before = pronation;
  }
}

TEST(JointAngles, GoOnOverHalfATurn) {
  std::vector<std::optional<double>> angles = {3.0, std::nullopt, -3.0, -2.9};
  unwrap(angles);
  EXPECT_NEAR(*angles[2], 2 * std::numbers::pi - 3.0, 1e-12);
  EXPECT_NEAR(*angles[3], 2 * std::numbers::pi - 2.9, 1e-12);
}

/// A walker at 1.2 m/s, a cycle a second: feet stand for 0.6 of it.
FeetPaths walker(double rate_hz, double seconds, double turn) {
  FeetPaths feet;
  const auto location = [&](double along, double aside) {
    const double angle = turn * along;
    return Vector<3>(along * std::cos(angle) - aside * std::sin(angle), along * std::sin(angle) + aside * std::cos(angle), 0.1);
  };
  for (int i = 0; i < static_cast<int>(seconds * rate_hz); ++i) {
    const double t = i / rate_hz;
    feet.sacrum.emplace_back(location(1.2 * t, 0));
    for (const Side side : kSides) {
      const double phase = t + (side == Side::left ? 0 : 0.5), cycle = std::floor(phase), part = phase - cycle;
      const double swing = std::clamp((part - 0.6) / 0.4, 0.0, 1.0),
                   ahead = 1.2 * (cycle - (side == Side::left ? 0 : 0.5) + swing -
                                  std::sin(2 * std::numbers::pi * swing) / (2 * std::numbers::pi));
      feet.heel[static_cast<std::size_t>(side)].emplace_back(location(ahead, side == Side::left ? 0.1 : -0.1));
      feet.toe[static_cast<std::size_t>(side)].emplace_back(location(ahead + 0.2, side == Side::left ? 0.1 : -0.1));
    }
  }
  return feet;
}

TEST(GaitEvents, AreFoundWhereverTheWalkGoes) {
  for (const double turn : {0.0, 0.3}) {
    FeetPaths feet = walker(100, 5, turn);
    for (std::size_t i = 130; i < 140; ++i) feet.heel[0][i].reset();
    const auto events = gait_events(feet, 100);
    int found = 0;
    for (const GaitEvent& event : events) {
      const double phase = event.time_s + (event.side == Side::left ? 0 : 0.5), part = phase - std::floor(phase);
      const double off = event.strike ? std::min(part, 1 - part) : std::abs(part - 0.6);
      EXPECT_LT(off, 0.12) << event.time_s;
      ++found;
    }
    EXPECT_GE(found, 17) << "two feet, five cycles, a strike and an off each, some at the rim";
  }
  EXPECT_TRUE(gait_events({}, 100).empty());
  FeetPaths still = walker(100, 3, 0);
  for (auto* path : {&still.heel[0], &still.heel[1], &still.toe[0], &still.toe[1], &still.sacrum})
    std::fill(path->begin(), path->end(), Vector<3>(1, 2, 0));
  EXPECT_TRUE(gait_events(still, 100).empty()) << "who stands takes no steps";
}

TEST(GaitCycles, MeasureTheWalk) {
  const FeetPaths feet = walker(100, 6, 0);
  const auto events = gait_events(feet, 100);
  std::vector<AngleCurve> angles = {{"left_knee_flexion", {}}};
  for (int i = 0; i < 600; ++i) angles[0].values.emplace_back(std::sin(2 * std::numbers::pi * i / 100));
  const GaitCycles cycles = gait_cycles(events, angles, feet, 100);
  ASSERT_GE(cycles.curves.at(0).cycles.size(), 3U);
  EXPECT_LT(cycles.curves[0].deviation[20], 0.02);
  const auto figure = [&](const std::string& name) {
    return *std::find_if(cycles.figures.begin(), cycles.figures.end(), [&](const GaitFigure& f) {
              return f.name == name;
            })->mean[0];
  };
  EXPECT_NEAR(figure("stride length"), 1.2, 0.01);
  EXPECT_NEAR(figure("cadence"), 120, 0.5);
  EXPECT_NEAR(figure("speed"), 1.2, 0.01);
  EXPECT_NEAR(figure("step width"), 0.2, 0.01);
  EXPECT_NEAR(figure("step length"), 0.6, 0.05);
}

TEST(GaitCycles, LeaveOutWhatJumpsOrIsNotKnownAndSaySo) {
  const FeetPaths feet = walker(100, 6, 0);
  const auto events = gait_events(feet, 100);
  std::vector<AngleCurve> angles = {{"left_elbow_pronation", {}}, {"left_shoulder_plane", {}}, {"left_hip_rotation", {}}};
  for (int i = 0; i < 600; ++i) {
    angles[0].values.emplace_back(i == 250 ? 3.0 : 0.1);
    angles[1].values.emplace_back(i == 250 ? std::nullopt : std::optional(0.1));
    angles[2].values.emplace_back(i < 200 ? 0.1 : 0.1 + 2 * std::numbers::pi);
  }
  const GaitCycles cycles = gait_cycles(events, angles, feet, 100);
  const auto count = [&](std::size_t curve) { return cycles.curves.at(curve).cycles.size(); };
  ASSERT_GE(count(0), 2U);
  EXPECT_EQ(cycles.curves[0].jumping, 1U);
  EXPECT_EQ(cycles.curves[0].unknown, 0U);
  EXPECT_EQ(cycles.curves[1].jumping, 0U);
  EXPECT_EQ(cycles.curves[1].unknown, 1U);
  for (std::size_t p = 0; p < kCyclePoints; ++p) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(cycles.curves[c].mean[p], 0.1, 1e-9) << c;
      EXPECT_NEAR(cycles.curves[c].deviation[p], 0, 1e-9) << c;
    }
  }
}

TEST(GaitCycles, EndWithTheNextStrike) {
  const FeetPaths feet = walker(100, 6, 0);
  std::vector<AngleCurve> angles = {{"left_knee_flexion", {}}};
  for (int i = 0; i < 600; ++i) angles[0].values.emplace_back(0.001 * i);
  const GaitCycles cycles = gait_cycles(gait_events(feet, 100), angles, feet, 100);
  EXPECT_EQ(kCyclePoints, 101U);
  EXPECT_NEAR(cycles.curves.at(0).cycles.at(0).front(), 0.1 * cycles.cycles.at(0).begin_s, 1e-9);
  EXPECT_NEAR(cycles.curves[0].cycles[0].back(), 0.1 * cycles.cycles[0].end_s, 1e-9);
}

TEST(LowPass, KeepsWhatIsSlowAndItsPlace) {
  std::vector<double> slow, both;
  for (int i = 0; i < 400; ++i) {
    slow.push_back(std::sin(2 * std::numbers::pi * i / 100.0));
    both.push_back(slow.back() + 0.3 * std::sin(2 * std::numbers::pi * 30 * i / 100.0));
  }
  const auto smooth = low_pass(both, 6, 100);
  for (std::size_t i = 50; i < 350; ++i) EXPECT_NEAR(smooth[i], slow[i], 0.01);
}

}  // namespace
}  // namespace marey::analyse::gait
