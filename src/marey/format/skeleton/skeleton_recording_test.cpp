#include "marey/format/skeleton/skeleton_recording.h"

#include <filesystem>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/read_file.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::format::skeleton {
namespace {

namespace fs = std::filesystem;

constexpr const char* kArm = R"(HIERARCHY
ROOT Shoulder
{
  OFFSET 0 150 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Elbow
  {
    OFFSET 30 0 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 25 0 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.02
0 150 0 0 0 0 0 0 0
10 150 20 90 0 0 -90 0 0
)";

std::map<std::string, Vector<3>> locations(FileReader& reader, const Instant& instant) {
  std::map<std::string, Vector<3>> by_label;
  const std::vector<TrackName> tracks = reader.tracks();
  for (const Sample& sample : instant.samples) {
    for (const TrackName& track : tracks) {
      if (track.id == sample.track) by_label[track.label] = sample.position;
    }
  }
  return by_label;
}

TEST(SkeletonRecording, JointsAreItsPointsAndBonesItsBodies) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "arm.bvh", kArm);
  EXPECT_EQ(format_of_content(folder / "arm.bvh")->name, "bvh");
  const auto reader = open_recording(folder / "arm.bvh");
  EXPECT_DOUBLE_EQ(reader->header().rate_hz, 50);
  EXPECT_EQ(reader->info().frame_count, 2);
  ASSERT_EQ(reader->header().bodies.size(), 2U);
  EXPECT_EQ(reader->header().bodies[1].label, "Elbow");
  EXPECT_EQ(reader->header().bodies[1].skeleton, "arm");
  auto found = locations(*reader, *reader->next());
  EXPECT_LT((found.at("Elbow") - Vector<3>(0.3, 0, 1.5)).norm(), 1e-12) << "cm, y up, into m, z up";
  const auto second = reader->next();
  found = locations(*reader, *second);
  EXPECT_EQ(found.size(), 3U);
  EXPECT_LT((found.at("Shoulder") - Vector<3>(0.1, -0.2, 1.5)).norm(), 1e-12);
  EXPECT_LT((found.at("Elbow") - Vector<3>(0.1, -0.2, 1.8)).norm(), 1e-12) << "the arm is raised";
  EXPECT_LT((found.at("Elbow.end") - Vector<3>(0.35, -0.2, 1.8)).norm(), 1e-12) << "the forearm is level";
  EXPECT_EQ(second->samples[0].provenance, Provenance::solved);
  EXPECT_LT((second->bodies[1].world_from_body.rotation - Matrix<3>::Identity()).norm(), 1e-12);
  EXPECT_FALSE(reader->next());
}

TEST(SkeletonRecording, UnitAndAxesAreTheUsers) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "arm.bvh", kArm);
  ReadOptions how;
  how.skeleton_unit_m = 0.0254;
  how.skeleton_up = UpAxis::z;
  const auto reader = open_recording(folder / "arm.bvh", how);
  EXPECT_LT((locations(*reader, *reader->next()).at("Elbow") - Vector<3>(0.762, 3.81, 0)).norm(), 1e-12);
}

TEST(SkeletonRecording, GoesThroughBvhAgain) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "arm.bvh", kArm);
  const Format& bvh = *format_named("bvh", Content::space);
  write_whole(folder / "again.bvh", bvh, read_whole(folder / "arm.bvh", bvh));
  const auto a = open_recording(folder / "arm.bvh"), b = open_recording(folder / "again.bvh");
  while (const auto required = a->next()) {
    const auto found = b->next();
    ASSERT_TRUE(found);
    for (std::size_t i = 0; i < required->samples.size(); ++i)
      EXPECT_LT((found->samples.at(i).position - required->samples[i].position).norm(), 1e-6);
  }
}

TEST(SkeletonRecording, WithoutMotionItRests) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "arm.bvh", std::string(kArm).substr(0, std::string(kArm).find("MOTION")));
  const auto reader = open_recording(folder / "arm.bvh");
  EXPECT_LT((locations(*reader, *reader->next()).at("Elbow.end") - Vector<3>(0.55, 0, 1.5)).norm(), 1e-12);
  EXPECT_FALSE(reader->next());
  EXPECT_NE(reader->warnings().at(0).find("has no motion"), std::string::npos);
}

TEST(SkeletonRecording, JointsThatNothingMovesAreRefused) {
  std::string text = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xposition\n";
  for (int i = 0; i < 200; ++i) text += "JOINT b" + std::to_string(i) + "\n{\nOFFSET 1 0 0\n}\n";
  text += "}\nMOTION\nFrames: 1\nFrame Time: 0.1\n0\n";
  EXPECT_THROW(recording_of(parse_bvh(text, "many.bvh"), "many.bvh"), Error);
}

TEST(Acclaim, FindsTheBonesOfItsFrames) {
  const test::TemporaryFolder folder;
  const std::string own = folder / "07_01.amc";
  test::write_file(own, "#!\n:FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 0 0 0 0 0\n");
  EXPECT_EQ(format_of_content(own)->name, "amc");
  EXPECT_THROW(asf_for(own), Error);
  test::write_file(folder / "other.asf", "");
  EXPECT_EQ(fs::path(asf_for(own)).filename(), "other.asf") << "the only one";
  test::write_file(folder / "third.asf", "");
  EXPECT_THROW(asf_for(own), Error);
  test::write_file(folder / "07.ASF", "");
  EXPECT_EQ(fs::path(asf_for(own)).filename(), "07.ASF") << "the subject's";
  test::write_file(folder / "07_01.asf", "");
  EXPECT_EQ(fs::path(asf_for(own)).filename(), "07_01.asf");
}

/// CMU's 01_01 as ASF/AMC and as BVH: legs are the same, the BVH's first frame is a pose of rest.
TEST(Acclaim, AgreesWithItsBvh) {
  const std::string folder = test::data("mocap_files/");
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not here";
  std::string amc, bvh;
  for (const auto& entry : fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied)) {
    if (entry.path().extension() == ".amc") amc = entry.path().string();
    if (entry.path().extension() == ".bvh") bvh = entry.path().string();
  }
  if (amc.empty() || bvh.empty()) GTEST_SKIP() << folder << " has no such pair";
  ReadOptions how;
  how.skeleton_unit_m = 0.0254 / 0.45;
  const auto a = open_recording(amc), b = open_recording(bvh, how);
  EXPECT_DOUBLE_EQ(a->header().rate_hz, 120);
  b->next();
  for (int frame = 0; frame < 200; ++frame) {
    const auto bones = locations(*a, *a->next()), joints = locations(*b, *b->next());
    // An AMC bone stands where it begins, as a BVH joint does.
    EXPECT_LT((bones.at("ltibia") - joints.at("LeftLeg")).norm(), 1e-4) << frame;
    EXPECT_LT((bones.at("rfoot") - joints.at("RightFoot")).norm(), 1e-4) << frame;
  }
}

TEST(Glb, SaysWhatIsInIt) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "arm.bvh", kArm);
  const Format& glb = *format_named("glb", Content::space);
  write_whole(folder / "arm.glb", glb, read_whole(folder / "arm.bvh", *format_of_content(folder / "arm.bvh")));
  ASSERT_EQ(format_of_content(folder / "arm.glb"), &glb);
  std::map<std::string, std::int64_t> counts;
  for (const Fact& fact : glb.facts(folder / "arm.glb")) {
    if (const auto* count = std::get_if<std::int64_t>(&fact.value)) counts[fact.name] = *count;
  }
  EXPECT_EQ(counts.at("animations"), 1);
  EXPECT_EQ(counts.at("skins"), 1);
  EXPECT_GE(counts.at("nodes"), 3);
  std::string bytes = test::read_file(folder / "arm.glb");
  test::write_file(folder / "cut.glb", bytes.substr(0, 100));
  EXPECT_THROW(glb.facts(folder / "cut.glb"), Error);
  bytes.replace(20, 40, std::string(40, 0x5b));
  test::write_file(folder / "bad.glb", bytes);
  EXPECT_THROW(glb.facts(folder / "bad.glb"), Error);
}

// ----- Vicon's skeletons

const char* const kVsk = R"(<?xml version="1.0"?>
<KinematicModel>
  <Parameters><Parameter NAME="Long" VALUE="250" /><Parameter NAME="Toe-X" VALUE="40" /></Parameters>
  <Skeleton>
    <Segment NAME="Trunk" POSITION="0 0 0" ORIENTATION="0 0 0"><JointFree />
      <Segment NAME="Arm" POSITION="0 2*Long-Long/5 -Toe-X" ORIENTATION="0 0 -1.5707963267948966"><JointBall />
        <Segment NAME="ForeArm" POSITION="0 Long 0"><JointHinge AXIS="0 0 2" />
          <Segment NAME="Hand_End" POSITION="0 200 0"><JointDummy /></Segment>
        </Segment>
      </Segment>
    </Segment>
  </Skeleton>
  <MarkerSet><Markers>
    <Marker NAME="ELB" SEGMENT="Arm" POSITION="-30 Long 0" /><Marker NAME="LOST" SEGMENT="Leg" POSITION="0 0 0" />
  </Markers></MarkerSet>
</KinematicModel>)";

TEST(Vsk, SegmentsHangWhereParametersSay) {
  const SkeletonFile file = parse_vsk(kVsk, "arm.vsk", {.up = UpAxis::z});
  const Skeleton& skeleton = file.skeleton;
  ASSERT_EQ(skeleton.segments.size(), 3U);
  EXPECT_EQ(skeleton.coordinates.size(), 6U + 3 + 1);
  ASSERT_TRUE(skeleton.segments[2].end);
  EXPECT_LT((*skeleton.segments[2].end - Vector<3>(0, 0.2, 0)).norm(), 1e-12);
  std::vector<double> pose(skeleton.coordinates.size(), 0);
  const auto rest = pose_of(skeleton, pose);
  EXPECT_LT((rest[1].translation - Vector<3>(0, 0.45, -0.04)).norm(), 1e-12);
  EXPECT_LT((rest[2].translation - Vector<3>(0.25, 0.45, -0.04)).norm(), 1e-12) << "the arm rests turned to the side";
  ASSERT_EQ(skeleton.markers.size(), 1U);
  EXPECT_LT((rest[1] * skeleton.markers[0].position - Vector<3>(0.25, 0.48, -0.04)).norm(), 1e-12);
  pose[9] = std::numbers::pi / 2;
  const auto bent = pose_of(skeleton, pose);
  EXPECT_LT((bent[2] * *skeleton.segments[2].end - Vector<3>(0.25, 0.65, -0.04)).norm(), 1e-12)
      << "the hinge has an axis of length 1";
  ASSERT_EQ(file.warnings.size(), 1U);
  EXPECT_NE(file.warnings[0].find("LOST"), std::string::npos);
}

TEST(Vsk, SaysWhatItCannotRead) {
  const auto error = [](const std::string& from, const std::string& to) {
    std::string text = kVsk;
    text.replace(text.find(from), from.size(), to);
    try {
      parse_vsk(text, "arm.vsk");
    } catch (const Error& thrown) {
      return std::string(thrown.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(error("2*Long-Long/5", "2*Short").find("no parameter that the file has"), std::string::npos);
  EXPECT_NE(error("2*Long-Long/5", "Long/0").find("beyond what a skeleton has"), std::string::npos);
  EXPECT_NE(error("VALUE=\"250\"", "VALUE=\"long\"").find("is no number"), std::string::npos);
  EXPECT_NE(error("<JointBall />", "<JointSpring />").find("hangs on no joint that Marey knows"), std::string::npos);
  EXPECT_NE(error("0 0 2", "0 0 0").find("no direction"), std::string::npos);
  EXPECT_NE(error("\"0 Long 0\"", "\"0 Long\"").find("2 numbers where 3 belong"), std::string::npos);
  EXPECT_NE(error("\"ForeArm\"", "\"Arm\"").find("two segments"), std::string::npos);
  std::string deep = "<KinematicModel>";
  for (int i = 0; i < 10'000; ++i) deep += "<Segment>";
  EXPECT_THROW(parse_vsk(deep, "deep.vsk"), Error);
}

TEST(Vsk, SubjectsFilesHoldTheirMarkers) {
  for (const char* name : {"Nick01.vsk", "SehoonVSK3.vsk"}) {
    const std::string path = test::data("vicon_skeleton/") + name;
    if (!fs::exists(path)) GTEST_SKIP() << path << " is not here";
    const SkeletonFile file = read_skeleton(path);
    EXPECT_EQ(file.skeleton.markers.size(), 53U) << name;
    EXPECT_TRUE(file.warnings.empty()) << name;
    EXPECT_EQ(kind_of(file.skeleton, file.skeleton.segments[0].joint), "free") << name;
  }
}

}  // namespace
}  // namespace marey::format::skeleton
