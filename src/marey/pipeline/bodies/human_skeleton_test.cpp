// People whose hips and knees are known, not where the conventional model has them, under skin that moves; then children.
#include "marey/pipeline/bodies/human_skeleton.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "marey/analyse/gait/body_marker_sets.h"
#include "marey/geometry/rigid.h"
#include "marey/pipeline/bodies/gait_markers.h"
#include "marey/simulate/random.h"
#include "marey/solve/skeleton/human.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::pipeline::bodies {
namespace {

constexpr double kTurn = std::numbers::pi / 180;

/// A standing person whose left hip is `hip` in the pelvis, and whose knees' axes are turned by 12° against what the markers say.
struct Truth {
  Vector<3> hip;
  Skeleton skeleton;

  /// With Plug-in Gait's markers, or the Cleveland Clinic's: triads on thighs and shanks, joints marked on both sides.
  explicit Truth(const Vector<3>& at, bool triads = false) : hip(at) {
    std::vector<solve::skeleton::StandingSegment> segments;
    std::vector<solve::skeleton::StandingMarker> markers;
    const Vector<3> up(0, 0, 0.95);
    const auto add = [&](const std::string& name, const Vector<3>& joint, const Matrix<3>& turn = Matrix<3>::Identity()) {
      segments.push_back({name, {turn, joint}});
    };
    const gait::BodyMarkerSet& set = triads ? gait::body_marker_set("cleveland-clinic") : gait::plug_in_gait();
    const auto mark = [&](const std::string& key, const std::string& on, const Vector<3>& location) {
      if (set.segment_of(key)) markers.push_back({set.label_of(key), on, location});
    };
    add("pelvis", up);
    mark("LASI", "pelvis", up + Vector<3>(0, 0.12, 0));
    mark("RASI", "pelvis", up + Vector<3>(0, -0.12, 0));
    mark("SACR", "pelvis", up + Vector<3>(-0.18, 0, 0.0));
    for (const double side : {1.0, -1.0}) {
      const std::string name = side > 0 ? "left_" : "right_", letter = side > 0 ? "L" : "R";
      const Vector<3> hip_at = up + Vector<3>(hip.x(), side * hip.y(), hip.z()), knee = hip_at - Vector<3>(0, 0, 0.41),
                      ankle = knee - Vector<3>(0, 0, 0.40);
      const Matrix<3> turn = geometry::rotation_from({0, 0, side * 12 * kTurn});
      add(name + "thigh", hip_at, turn);
      add(name + "shank", knee, turn);
      add(name + "foot", ankle);
      mark(letter + "THI", name + "thigh", hip_at + Vector<3>(0.0, side * 0.10, -0.22));
      mark(letter + "KNE", name + "thigh", knee + turn * Vector<3>(0, side * 0.055, 0));
      mark(letter + "TIB", name + "shank", knee + Vector<3>(0.02, side * 0.06, -0.18));
      mark(letter + "ANK", name + "shank", ankle + Vector<3>(0, side * 0.042, 0));
      mark(letter + "KNM", name + "thigh", knee - turn * Vector<3>(0, side * 0.055, 0));
      mark(letter + "ANM", name + "shank", ankle - turn * Vector<3>(0, side * 0.042, 0));
      mark(letter + ".Thigh.Front", name + "thigh", hip_at + Vector<3>(0.08, side * 0.03, -0.20));
      mark(letter + ".Thigh.Rear", name + "thigh", hip_at + Vector<3>(-0.05, side * 0.06, -0.12));
      mark(letter + ".Shank.Front", name + "shank", knee + Vector<3>(0.05, side * 0.01, -0.15));
      mark(letter + ".Shank.Rear", name + "shank", knee + Vector<3>(-0.04, side * 0.04, -0.22));
      mark(letter + "HEE", name + "foot", ankle + Vector<3>(-0.05, 0, -0.05));
      mark(letter + "TOE", name + "foot", ankle + Vector<3>(0.15, 0, -0.05));
    }
    skeleton = solve::skeleton::human_skeleton("truth", segments, markers);
  }

  /// Labelled points, a row a marker and frame: standing, or 20 s of legs that swing ahead, aside and round, and knees that bend.
  std::string csv(bool moves, double skin_m, std::uint64_t seed) const {
    marey::simulate::Random random(seed);
    std::vector<Matrix<3>> carried;
    for (const SkeletonMarker& marker : skeleton.markers) {
      const std::string& on = skeleton.segments[static_cast<std::size_t>(marker.segment)].name;
      const double far = on == "pelvis" ? 0.3 * skin_m : on.ends_with("foot") ? 0.1 * skin_m : skin_m;
      carried.emplace_back(Matrix<3>::NullaryExpr([&] { return random.uniform(-far / 2, far / 2); }));
    }
    std::string text = "frame,time,id,label,x,y,z\n";
    for (int i = 0; i < (moves ? 1000 : 50); ++i) {
      const double t = i / 50.0;
      std::vector<double> row = skeleton.rest();
      const auto set = [&](const char* name, double degrees) {
        row[static_cast<std::size_t>(skeleton.coordinate(name).value())] = degrees * kTurn;
      };
      Vector<3> fraction[2] = {Vector<3>::Zero(), Vector<3>::Zero()};
      for (const int side : {0, 1}) {
        if (!moves) break;
        const std::string name = side == 0 ? "left_" : "right_";
        fraction[side] = {std::sin(2.1 * t + side), std::sin(1.37 * t + side), std::sin(0.83 * t + 1)};
        set((name + "hip_flexion").c_str(), 15 + 30 * fraction[side].x());
        set((name + "hip_adduction").c_str(), 20 * fraction[side].y());
        set((name + "hip_rotation").c_str(), 12 * fraction[side].z());
        set((name + "knee_flexion").c_str(), 40 + 35 * std::sin(1.7 * t));
      }
      const auto pose = marey::pose_of(skeleton, row);
      for (std::size_t m = 0; m < skeleton.markers.size(); ++m) {
        const SkeletonMarker& marker = skeleton.markers[m];
        const Vector<3> moved = carried[m] * fraction[marker.label.front() == 'R' ? 1 : 0];
        const Vector<3> noise(random.gaussian(0, 0.0003), random.gaussian(0, 0.0003), random.gaussian(0, 0.0003));
        const Vector<3> at = pose[static_cast<std::size_t>(marker.segment)] * (marker.position + moved) + noise;
        text += fmt::format("{},{:.3f},{},{},{:.6f},{:.6f},{:.6f}\n", i, t, m + 1, marker.label, at.x(), at.y(), at.z());
      }
    }
    return text;
  }
};

Vector<3> joint_in_pelvis(const Skeleton& skeleton, const char* segment) {
  return skeleton.segments[static_cast<std::size_t>(skeleton.segment(segment).value())].joint.parent_from_joint.translation;
}

/// How far the left thigh's frame is turned against the truth's, about its length: by where the thigh's marker lies in it; degrees.
double knee_off(const Skeleton& skeleton, const Truth& truth) {
  const auto direction = [](const Skeleton& of) {
    const auto marker = std::find_if(of.markers.begin(), of.markers.end(), [](const SkeletonMarker& each) {
      return each.label == "LTHI" || each.label == "L.Thigh.Upper";
    });
    return std::atan2(marker->position.x(), marker->position.y());
  };
  return std::abs(direction(skeleton) - direction(truth.skeleton)) / kTurn;
}

struct Errors {
  double regression = 0, motion = 0, stated = 0;              // m
  double knee_markers = 0, knee_motion = 0, knee_stated = 0;  // degrees
};

Errors hip_errors(const Truth& truth, double skin_m, std::uint64_t seed, std::vector<FoundJoint>& joints) {
  const test::TemporaryFolder here;
  test::write_file(here / "standing.csv", truth.csv(false, 0, seed));
  test::write_file(here / "range.csv", truth.csv(true, skin_m, seed));
  const HumanSkeleton before = human_from_static(here / "standing.csv", {}, {});
  const HumanSkeleton after = human_from_static(here / "standing.csv", {.motion = here / "range.csv"}, {});
  EXPECT_TRUE(before.joints.empty());
  joints = after.joints;
  return {(joint_in_pelvis(before.skeleton, "left_thigh") - truth.hip).norm(),
          (joint_in_pelvis(after.skeleton, "left_thigh") - truth.hip).norm(),
          after.joints.front().deviation,
          knee_off(before.skeleton, truth),
          knee_off(after.skeleton, truth),
          after.joints[2].deviation / kTurn};
}

TEST(HumanSkeleton, FindsTheHipsOfWhomSkinDoesNotDeceive) {
  std::vector<FoundJoint> joints;
  const Errors errors = hip_errors(Truth({-0.035, 0.088, -0.085}), 0, 1, joints);
  std::printf("regression %.1f mm off, motion %.2f mm\n", 1000 * errors.regression, 1000 * errors.motion);
  ASSERT_EQ(joints.size(), 4u);
  for (const FoundJoint& joint : joints) {
    EXPECT_TRUE(joint.by_motion) << joint.stated;
    std::printf("%s\n", joint.stated.c_str());
  }
  std::printf("knee's axis: %.1f deg off by markers, %.1f with the motion\n", errors.knee_markers, errors.knee_motion);
  EXPECT_GT(errors.regression, 0.012);
  EXPECT_LT(errors.motion, 0.003);
  EXPECT_GT(errors.knee_markers, 8);
  EXPECT_LT(errors.knee_motion, 0.5 * errors.knee_markers) << "beside what skin might do the markers have a say";
}

/// RMS of twelve people's errors; their regression is 20 mm off, their knees' markers 12°.
Errors errors_under_skin(double skin_m, bool triads = false) {
  Errors mean;
  constexpr int kPeople = 12;
  for (std::uint64_t seed = 1; seed <= kPeople; ++seed) {
    marey::simulate::Random random(seed);
    const Vector<3> off(random.gaussian(0, 0.0115), random.gaussian(0, 0.0115), random.gaussian(0, 0.0115));
    std::vector<FoundJoint> joints;
    const Errors errors = hip_errors(Truth(Vector<3>(-0.047, 0.078, -0.097) + off, triads), skin_m, seed, joints);
    mean.regression += errors.regression * errors.regression / kPeople;
    mean.motion += errors.motion * errors.motion / kPeople;
    mean.knee_markers += errors.knee_markers * errors.knee_markers / kPeople;
    mean.knee_motion += errors.knee_motion * errors.knee_motion / kPeople;
  }
  for (double* each : {&mean.regression, &mean.motion, &mean.knee_markers, &mean.knee_motion}) *each = std::sqrt(*each);
  std::printf("skin %.0f mm: hip %.1f mm by the regression, %.1f with the motion; knee's axis %.1f deg by markers, %.1f with it\n",
              1000 * skin_m, 1000 * mean.regression, 1000 * mean.motion, mean.knee_markers, mean.knee_motion);
  return mean;
}

/// Two markers on a thigh are few: what skin of a thick leg leaves of the motion is less than what the conventional model knows,
/// and must not make it worse.
TEST(HumanSkeleton, IsNearerThanTheConventionalModelUnderSkin) {
  const Errors little = errors_under_skin(0.004), much = errors_under_skin(0.018);
  EXPECT_LT(little.motion, 0.85 * little.regression);
  EXPECT_LT(little.knee_motion, 0.7 * little.knee_markers);
  EXPECT_LT(much.motion, 1.05 * much.regression);
  EXPECT_LT(much.knee_motion, 1.05 * much.knee_markers);
}

/// What triads are for. Knees and ankles that are marked on both sides need no wand.
TEST(HumanSkeleton, KnowsMoreByTheClevelandClinicsTriads) {
  const Errors much = errors_under_skin(0.018, true);
  EXPECT_LT(much.motion, 0.9 * much.regression);
  EXPECT_LT(much.knee_markers, 2.5);
  EXPECT_LT(much.knee_motion, 4);
}

TEST(HumanSkeleton, KeepsTheConventionalJointsOfWhoDoesNotMove) {
  const Truth truth({-0.035, 0.088, -0.085});
  const test::TemporaryFolder here;
  test::write_file(here / "standing.csv", truth.csv(false, 0, 1));
  const HumanSkeleton alone = human_from_static(here / "standing.csv", {}, {});
  const HumanSkeleton still = human_from_static(here / "standing.csv", {.motion = here / "standing.csv"}, {});
  ASSERT_EQ(still.joints.size(), 4u);
  for (const FoundJoint& joint : still.joints) {
    EXPECT_FALSE(joint.by_motion);
    EXPECT_NE(joint.stated.find("stays"), std::string::npos) << joint.stated;
  }
  EXPECT_EQ(joint_in_pelvis(alone.skeleton, "left_thigh"), joint_in_pelvis(still.skeleton, "left_thigh"));
}

/// No range of motion, but a walk and a turn: the result is a person's all the same, and left is as right.
TEST(HumanSkeleton, OfChildrenIsPlausible) {
  const std::string children = test::data("gait_children/");
  if (!std::filesystem::exists(children)) GTEST_SKIP() << children << " is not here";
  const std::map<std::string, std::pair<const char*, const char*>> trials = {
      {"HC002D", {"static_HC002D02.c3d", "turn_HC002D25.c3d"}}, {"HC030A", {"static_HC030A01.c3d", "turn_HC030A22.c3d"}},
      {"HC031A", {"static_HC031A01.c3d", "turn_HC031A23.c3d"}}, {"HC033A", {"static_HC033A01.c3d", "turn_HC033A22.c3d"}},
      {"HC038A", {"static_HC038A01.c3d", "turn_HC038A27.c3d"}}, {"HC044A", {"static_HC044A01.c3d", "turn_HC044A29.c3d"}}};
  for (const auto& [child, files] : trials) {
    const std::string own = children + child + "/";
    const HumanSkeleton human = human_from_static(own + files.first, {.motion = own + files.second}, {});
    const Vector<3> left = joint_in_pelvis(human.skeleton, "left_thigh"), right = joint_in_pelvis(human.skeleton, "right_thigh");
    std::printf("%s: hips %.0f mm apart, left and right differ by %.0f mm\n", child.c_str(), 1000 * (left - right).norm(),
                1000 * (left - Vector<3>(right.x(), -right.y(), right.z())).norm());
    for (const FoundJoint& joint : human.joints) std::printf("  %s\n", joint.stated.c_str());
    EXPECT_GT((left - right).norm(), 0.08) << child;
    EXPECT_LT((left - right).norm(), 0.22) << child;
    EXPECT_LT((left - Vector<3>(right.x(), -right.y(), right.z())).norm(), 0.03) << child;
    EXPECT_GE(human.joints.size(), 4u);
  }
}

}  // namespace
}  // namespace marey::pipeline::bodies
