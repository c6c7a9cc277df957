#include "marey/analyse/gait/anatomical_pose.h"

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "marey/analyse/gait/joint_angles.h"

namespace marey::analyse::gait {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

Matrix<3> rotation(double y, double x, double z) {
  return (Eigen::AngleAxisd(y, Vector<3>::UnitY()) * Eigen::AngleAxisd(x, Vector<3>::UnitX()) *
          Eigen::AngleAxisd(z, Vector<3>::UnitZ()))
      .toRotationMatrix();
}

struct LegAngles {
  double hip_flexion = 0, hip_adduction = 0, hip_rotation = 0, knee_flexion = 0, dorsiflexion = 0;  // rad
};

/// A leg of 0.4 m thigh and shank below the hip, its landmarks with joints 0.1 and 0.08 m wide.
void add_leg(MarkerPositions& marks, const Rigid3& pelvis, Side side, const LegAngles& angles) {
  const double left = side == Side::left ? 1 : -1;
  const std::string name = side == Side::left ? "left_" : "right_";
  const Vector<3> hip = pelvis * Vector<3>(-0.03, left * 0.09, -0.08);
  const Matrix<3> thigh =
      pelvis.rotation * rotation(-angles.hip_flexion, -left * angles.hip_adduction, -left * angles.hip_rotation);
  const Vector<3> knee = hip - 0.4 * thigh.col(2);
  const Matrix<3> shank = thigh * rotation(angles.knee_flexion, 0, 0);
  const Vector<3> ankle = knee - 0.4 * shank.col(2);
  const Matrix<3> foot = shank * rotation(-angles.dorsiflexion, 0, 0);
  marks[name + "hip_centre"] = hip;
  marks[name + "knee_lateral"] = knee + left * 0.05 * thigh.col(1);
  marks[name + "knee_medial"] = knee - left * 0.05 * thigh.col(1);
  marks[name + "ankle_lateral"] = ankle + left * 0.04 * shank.col(1);
  marks[name + "ankle_medial"] = ankle - left * 0.04 * shank.col(1);
  marks[name + "heel"] = ankle + foot * Vector<3>(-0.05, 0, -0.06);
  marks[name + "toe"] = ankle + foot * Vector<3>(0.14, -left * 0.02, -0.06);
  marks[name + "meta"] = ankle + foot * Vector<3>(0.10, left * 0.02, -0.06);
}

MarkerPositions person(const Rigid3& pelvis, const LegAngles& left, const LegAngles& right) {
  MarkerPositions marks;
  for (const double side : {1.0, -1.0}) {
    const std::string name = side > 0 ? "left_" : "right_";
    marks[name + "asis"] = pelvis * Vector<3>(0, side * 0.12, 0);
    marks[name + "psis"] = pelvis * Vector<3>(-0.15, side * 0.05, 0);
    marks[name + "shoulder"] = pelvis * Vector<3>(-0.03, side * 0.2, 0.45);
  }
  add_leg(marks, pelvis, Side::left, left);
  add_leg(marks, pelvis, Side::right, right);
  return marks;
}

double angle(const std::vector<std::optional<double>>& angles, const std::string& name) {
  const auto names = angle_names();
  const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  return angles.at(at).value() / kRadians;
}

TEST(AnatomicalPose, GivesBackTheAnglesOfALegOnBothSides) {
  const LegAngles left{.hip_flexion = 30 * kRadians,
                       .hip_adduction = 5 * kRadians,
                       .hip_rotation = -8 * kRadians,
                       .knee_flexion = 40 * kRadians,
                       .dorsiflexion = 12 * kRadians};
  const LegAngles right{.hip_flexion = -15 * kRadians,
                        .hip_adduction = -7 * kRadians,
                        .hip_rotation = 4 * kRadians,
                        .knee_flexion = 3 * kRadians,
                        .dorsiflexion = -20 * kRadians};
  const Rigid3 pelvis{rotation(0.1, -0.05, 1.3), Vector<3>(3, -2, 1)};
  const auto angles = angles_of(anatomical_pose(person(pelvis, left, right)), Vector<2>::UnitX());
  for (const auto& [side, leg] : {std::pair{"left_", left}, std::pair{"right_", right}}) {
    EXPECT_NEAR(angle(angles, side + std::string("hip_flexion")), leg.hip_flexion / kRadians, 1e-9);
    EXPECT_NEAR(angle(angles, side + std::string("hip_adduction")), leg.hip_adduction / kRadians, 1e-9);
    EXPECT_NEAR(angle(angles, side + std::string("hip_rotation")), leg.hip_rotation / kRadians, 1e-9);
    EXPECT_NEAR(angle(angles, side + std::string("knee_flexion")), leg.knee_flexion / kRadians, 1e-9);
    EXPECT_NEAR(angle(angles, side + std::string("knee_adduction")), 0, 1e-9);
    EXPECT_NEAR(angle(angles, side + std::string("ankle_dorsiflexion")), leg.dorsiflexion / kRadians, 1e-9);
  }
}

TEST(AnatomicalPose, IsSilentAboutSegmentsWhoseLandmarksAreAbsent) {
  MarkerPositions marks = person(Rigid3{Matrix<3>::Identity(), Vector<3>(0, 0, 1)}, {}, {});
  marks.erase("left_knee_medial");
  const GaitPose pose = anatomical_pose(marks);
  EXPECT_TRUE(pose[SegmentId::pelvis]);
  EXPECT_FALSE(pose[SegmentId::left_thigh]);
  EXPECT_FALSE(pose[SegmentId::left_shank]);
  EXPECT_FALSE(pose[SegmentId::left_foot]);
  EXPECT_TRUE(pose[SegmentId::right_foot]);
  EXPECT_FALSE(pose[SegmentId::left_upper_arm]);
  marks["right_asis"] = marks["left_asis"];
  EXPECT_FALSE(anatomical_pose(marks)[SegmentId::pelvis]);
}

}  // namespace
}  // namespace marey::analyse::gait
