#include "marey/format/skeleton/rig_names.h"

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/core/recording.h"
#include "marey/format/skeleton/skeleton_file.h"

#include "support/files.h"

namespace marey::format::skeleton {
namespace {

Body bone(int id, const char* label, std::optional<int> parent, const Vector<3>& offset, std::optional<Vector<3>> end = {}) {
  Body body;
  body.id = BodyId{id};
  body.label = label;
  body.skeleton = "person";
  if (parent) body.parent = BodyId{*parent};
  body.offset = offset;
  body.end = end;
  return body;
}

/// A person who stands with their arms down, x ahead, y to the left, z up.
RecordingHeader person_header() {
  RecordingHeader header;
  header.rate_hz = 100;
  header.bodies = {bone(1, "pelvis", {}, {0, 0, 0}),
                   bone(2, "trunk", 1, {0, 0, 0.1}),
                   bone(3, "left_upper_arm", 2, {0, 0.2, 0.4}),
                   bone(4, "left_forearm", 3, {0.01, 0.02, -0.3}),
                   bone(5, "left_hand", 4, {0, 0, -0.25}, Vector<3>(0, 0, -0.1)),
                   bone(6, "left_thigh", 1, {0, 0.1, 0}),
                   bone(7, "left_shank", 6, {0, 0, -0.42}),
                   bone(8, "right_thigh", 1, {0, -0.1, 0}),
                   bone(9, "tail", 1, {-0.1, 0, 0}, Vector<3>(-0.3, 0, 0))};
  return header;
}

/// Bones that all turn, by frame.
Instant moved(const RecordingHeader& header, int frame) {
  Instant instant;
  instant.index = frame;
  std::map<BodyId, Rigid3> poses;
  for (const Body& body : header.bodies) {
    const double angle = 0.2 * frame * (1 + 0.1 * static_cast<double>(number(body.id)));
    const Matrix<3> turn = Eigen::AngleAxisd(angle, Vector<3>(0.3, 0.5, 0.8).normalized()).toRotationMatrix();
    Rigid3 pose{turn, Vector<3>(0.1 * frame, 0, 1)};
    if (body.parent) pose = poses.at(*body.parent) * Rigid3{turn, body.offset};
    poses[body.id] = pose;
    instant.bodies.push_back({.body = body.id, .world_from_body = pose, .covariance = {}, .residual_m = {}});
  }
  return instant;
}

/// Takes what a scheme makes of a recording.
class Listener final : public Sink {
 public:
  std::string name() const override { return "listener"; }
  SinkRequirements begin(const RecordingHeader& header) override {
    bodies = header.bodies;
    return {};
  }
  void write(const Instant& instant) override { instants.push_back(instant); }
  void finish() override {}

  std::vector<Body> bodies;
  std::vector<Instant> instants;
};

struct NamedRecording {
  std::vector<Body> bodies;
  std::vector<Instant> instants;

  const Body& labelled(const std::string& label) const { return *std::ranges::find(bodies, label, &Body::label); }
};

NamedRecording named_recording(const RecordingHeader& header, const std::string& scheme) {
  auto listener = std::make_unique<Listener>();
  Listener& named = *listener;
  const auto sink = with_rig_scheme(std::move(listener), rig_scheme(scheme));
  sink->begin(header);
  for (int frame = 0; frame < 5; ++frame) sink->write(moved(header, frame));
  sink->finish();
  return {named.bodies, named.instants};
}

TEST(RigNames, JointsStayWhereTheyAreAndHangTogether) {
  const RecordingHeader header = person_header();
  for (const std::string scheme : {"mixamo", "unreal", "vrm", "rokoko", "rigify", "motionbuilder"}) {
    const NamedRecording named = named_recording(header, scheme);
    ASSERT_EQ(named.bodies.size(), header.bodies.size() + (scheme == "unreal" ? 1 : 0)) << scheme;
    for (int frame = 0; frame < 5; ++frame) {
      std::map<BodyId, Rigid3> poses;
      for (const BodyPose& pose : named.instants[static_cast<std::size_t>(frame)].bodies) poses[pose.body] = pose.world_from_body;
      for (const BodyPose& own : moved(header, frame).bodies)
        EXPECT_LT((poses.at(own.body).translation - own.world_from_body.translation).norm(), 1e-12) << scheme;
      for (const Body& body : named.bodies) {
        EXPECT_NEAR(poses.at(body.id).rotation.determinant(), 1, 1e-9);
        if (!body.parent || body.label == "pelvis") continue;
        EXPECT_LT((poses.at(*body.parent) * body.offset - poses.at(body.id).translation).norm(), 1e-12) << scheme << body.label;
      }
    }
  }
}

TEST(RigNames, AtRestTheArmsAreAsTheProgramHasThem) {
  const NamedRecording t = named_recording(person_header(), "mixamo"), a = named_recording(person_header(), "unreal");
  EXPECT_LT((t.labelled("mixamorig:LeftForeArm").offset.normalized() - Vector<3>(1, 0, 0)).norm(), 1e-9);
  EXPECT_LT((t.labelled("mixamorig:LeftHand").offset.normalized() - Vector<3>(1, 0, 0)).norm(), 1e-9);
  EXPECT_LT((*t.labelled("mixamorig:LeftHand").end - Vector<3>(0.1, 0, 0)).norm(), 1e-9);
  EXPECT_LT((a.labelled("lowerarm_l").offset.normalized() - Vector<3>(1, 0, -1).normalized()).norm(), 1e-9);
  EXPECT_LT((t.labelled("mixamorig:LeftUpLeg").offset - Vector<3>(0.1, 0, 0)).norm(), 1e-9) << "it faces -y: its left is x";
  EXPECT_LT((*t.labelled("tail").end - Vector<3>(0, 0.3, 0)).norm(), 1e-9) << "an unknown bone keeps its name, and turns along";
  EXPECT_EQ(a.bodies.front().label, "root");
  EXPECT_EQ(a.labelled("pelvis").parent, a.bodies.front().id);
}

TEST(RigNames, BonesOfOtherProgramsAreKnown) {
  const RigScheme& mixamo = rig_scheme("mixamo");
  const RigScheme& rigify = rig_scheme("rigify");
  for (const char* label : {"left_thigh", "femur_l", "LeftUpLeg", "mixamorig:LeftUpLeg", "thigh_l", "thigh.L", "leftUpperLeg"}) {
    EXPECT_EQ(rig_bone_name(mixamo, label), "mixamorig:LeftUpLeg") << label;
    EXPECT_EQ(rig_bone_name(rigify, label), "thigh.L") << label;
  }
  EXPECT_EQ(rig_bone_name(mixamo, "racket"), "racket");
  EXPECT_EQ(rig_bone_name(rig_scheme("motionbuilder"), "ulna_r"), "RightForeArm");
}

TEST(RigNames, AChestIsTheTrunkWhereThereIsNoOther) {
  RecordingHeader header = person_header();
  header.bodies[1].label = "chest";
  EXPECT_EQ(named_recording(header, "vrm").bodies[1].label, "spine");
  header = person_header();
  header.bodies[8].label = "chest";
  EXPECT_EQ(named_recording(header, "vrm").bodies[8].label, "chest");
  header.bodies[8].label = "torso";
  EXPECT_EQ(named_recording(header, "vrm").bodies[8].label, "torso") << "the trunk has that name already";
}

TEST(RigNames, RejectsSkeletonsWithoutLegs) {
  EXPECT_THROW(rig_scheme("maya"), Error);
  RecordingHeader header = person_header();
  header.bodies.resize(5);
  try {
    named_recording(header, "vrm");
    ADD_FAILURE() << "a person without legs";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("two thighs"), std::string::npos) << error.what();
  }
  EXPECT_THROW(create_bones("x.bvh", {.rig_names = "vrm", .bvh_order = "XXY"}), Error);
}

TEST(RigNames, KnowBonesThatHaveJointsNames) {
  RecordingHeader header;  // as Xsens MVN's BVH files call them
  header.rate_hz = 60;
  header.bodies = {bone(1, "Hips", {}, {0, 0, 0}),           bone(2, "Chest", 1, {0, 0, 0.1}),
                   bone(3, "LeftCollar", 2, {0, 0.05, 0.4}), bone(4, "LeftShoulder", 3, {0, 0.15, 0}),
                   bone(5, "LeftElbow", 4, {0, 0.3, 0}),     bone(6, "LeftWrist", 5, {0, 0.25, 0}, Vector<3>(0, 0.1, 0)),
                   bone(7, "LeftHip", 1, {0, 0.1, 0}),       bone(8, "LeftKnee", 7, {0, 0, -0.42}),
                   bone(9, "LeftAnkle", 8, {0, 0, -0.4}),    bone(10, "RightHip", 1, {0, -0.1, 0})};
  auto listener = std::make_unique<Listener>();
  Listener& heard = *listener;
  const auto sink = with_rig_scheme(std::move(listener), rig_scheme("motionbuilder"));
  sink->begin(header);
  std::vector<std::string> names;
  for (const Body& body : heard.bodies) names.push_back(body.label);
  EXPECT_EQ(names, (std::vector<std::string>{"Hips", "Spine", "LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand", "LeftUpLeg",
                                             "LeftLeg", "LeftFoot", "RightUpLeg"}));
}

TEST(RigNames, KnowTheiasSegments) {
  const RigScheme& unreal = rig_scheme("unreal");
  for (const auto& [theia, name] : std::vector<std::pair<std::string, std::string>>{{"l_uarm", "upperarm_l"},
                                                                                    {"r_larm", "lowerarm_r"},
                                                                                    {"l_larm", "lowerarm_l"},
                                                                                    {"torso", "spine_01"},
                                                                                    {"r_toes", "ball_r"}})
    EXPECT_EQ(rig_bone_name(unreal, theia), name) << theia;
}

}  // namespace
}  // namespace marey::format::skeleton
