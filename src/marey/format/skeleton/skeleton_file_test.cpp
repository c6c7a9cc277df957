#include "marey/format/skeleton/skeleton_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <sstream>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/read_file.h"
#include "marey/format/skeleton/bvh.h"
#include "marey/format/skeleton/gltf.h"
#include "marey/format/skeleton/motion_table.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::format::skeleton {
namespace {

namespace fs = std::filesystem;

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

constexpr SkeletonOptions kAsWritten{.unit_m = 1, .up = UpAxis::z, .rate_hz = 120};

/// Where the joints and the ends of segments without children are, by name.
Vector<3> position_of(const Skeleton& skeleton, const std::vector<Rigid3>& pose, const std::string& name) {
  if (const auto segment = skeleton.segment(name)) return pose[static_cast<std::size_t>(*segment)].translation;
  const auto segment = static_cast<std::size_t>(skeleton.segment(name.substr(0, name.size() - 4)).value());  // "Head_End"
  return pose[segment] * skeleton.segments[segment].end.value();
}

TEST(Bvh, AgreesWithAnotherPrograms) {
  const std::string folder = test::data("bvh_dialects/bvh_toolbox/");
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not here";
  const SkeletonFile file = parse_bvh(read_file(folder + "walk01.bvh"), "walk01.bvh", kAsWritten);
  ASSERT_TRUE(file.motion);
  EXPECT_EQ(file.motion->rows.size(), 101U);
  EXPECT_NEAR(file.motion->rate_hz, 24, 1e-9);
  std::istringstream table(read_file(folder + "walk01_pos.csv"));
  std::string head, line;
  std::getline(table, head);
  std::vector<std::string> columns;
  for (std::istringstream cells(head); std::getline(cells, line, ',');) columns.push_back(line);
  double worst = 0;
  for (std::size_t r = 0; std::getline(table, line) && r < file.motion->rows.size(); ++r) {
    const auto pose = pose_of(file.skeleton, file.motion->rows[r]);
    std::vector<double> values;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) values.push_back(std::stod(cell));
    for (std::size_t c = 1; c + 2 < values.size(); c += 3) {
      const Vector<3> there(values[c], values[c + 1], values[c + 2]);
      worst = std::max(worst, (position_of(file.skeleton, pose, columns[c].substr(0, columns[c].size() - 2)) - there).norm());
    }
  }
  EXPECT_LT(worst, 2e-5) << "units of the file, whose table has five decimals";
}

TEST(Bvh, ReadsEveryDialect) {
  const std::string folder = test::data("bvh_dialects/");
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not here";
  struct Dialect {
    const char* name;
    std::size_t joints, frames;
    double rate_hz;
  };
  for (const Dialect& dialect : {Dialect{"bvh_toolbox/test_freebvh.bvh", 55, 69, 30},
                                 {"bvh_toolbox/test_mocapbank.bvh", 19, 455, 30},
                                 {"pymo/AV_8Walk_Meredith_HVHA_Rep1.bvh", 23, 1064, 120},
                                 {"openmocap/default.bvh", 18, 0, 0},
                                 {"openmocap/chessboard.bvh", 5, 0, 0}}) {
    SCOPED_TRACE(dialect.name);
    const SkeletonFile file = read_skeleton(folder + dialect.name);
    EXPECT_EQ(file.skeleton.segments.size(), dialect.joints);
    EXPECT_EQ(file.motion ? file.motion->rows.size() : 0, dialect.frames);
    if (file.motion) {
      EXPECT_NEAR(file.motion->rate_hz, dialect.rate_hz, 0.01);
    }
    EXPECT_TRUE(file.warnings.empty());
  }
}

/// CMU's walk twice: BVH has a first row more, and lacks the thorax bone, so that legs agree and what is above sits lower by it.
TEST(Asf, AgreesWithItsBvhTwin) {
  const std::string folder = test::data("mocap_files/cmu/");
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not here";
  const SkeletonFile bvh = parse_bvh(read_file(folder + "01_01.bvh"), "01_01.bvh", kAsWritten);
  const SkeletonFile asf = parse_asf(read_file(folder + "01.asf"), "01.asf", kAsWritten);
  const SkeletonMotion amc = parse_amc(read_file(folder + "01_01.amc"), "01_01.amc", asf, kAsWritten);
  ASSERT_TRUE(bvh.motion);
  EXPECT_EQ(bvh.motion->rows.size(), 2752U);
  EXPECT_EQ(amc.rows.size(), 2751U);
  EXPECT_NEAR(asf.unit_m, 0.0254 / 0.45, 1e-12);
  const std::vector<std::pair<std::string, std::string>> same = {
      {"LeftUpLeg", "lfemur"}, {"LeftLeg", "ltibia"},  {"LeftFoot", "lfoot"}, {"RightUpLeg", "rfemur"},
      {"RightLeg", "rtibia"},  {"RightFoot", "rfoot"}, {"Spine", "upperback"}};
  double worst = 0, lower_least = 1e9, lower_most = 0;
  for (std::size_t k = 0; k < amc.rows.size(); k += 50) {
    const auto by_bvh = pose_of(bvh.skeleton, bvh.motion->rows[k + 1]);
    const auto by_asf = pose_of(asf.skeleton, amc.rows[k]);
    for (const auto& [joint, bone] : same) {
      worst =
          std::max(worst, (position_of(bvh.skeleton, by_bvh, joint) - position_of(asf.skeleton, by_asf, bone) / asf.unit_m).norm());
    }
    const double lower =
        (position_of(bvh.skeleton, by_bvh, "LeftShoulder") - position_of(asf.skeleton, by_asf, "lclavicle") / asf.unit_m).norm();
    lower_least = std::min(lower_least, lower);
    lower_most = std::max(lower_most, lower);
  }
  EXPECT_LT(worst, 1e-3);
  EXPECT_NEAR(lower_least, 2.065, 2e-3);
  EXPECT_NEAR(lower_most, 2.065, 2e-3);
}

/// A BVH file as a recording with bodies, into a sink.
void write_again(const SkeletonFile& file, Sink& sink) {
  RecordingHeader header;
  header.rate_hz = file.motion->rate_hz;
  header.bodies = bodies_of(file.skeleton);
  const auto rest = rest_of(file.skeleton);
  sink.begin(header);
  for (std::size_t r = 0; r < file.motion->rows.size(); ++r) {
    Instant instant;
    instant.index = static_cast<std::int64_t>(r);
    instant.time = file.motion->times[r];
    const auto pose = pose_of(file.skeleton, file.motion->rows[r]);
    for (std::size_t s = 0; s < pose.size(); ++s)
      instant.bodies.push_back({.body = header.bodies[s].id,
                                .world_from_body = body_pose(pose[s], rest[s]),
                                .covariance = {},
                                .residual_m = {},
                                .tracked = true});
    sink.write(instant);
  }
  sink.finish();
}

TEST(Bvh, IsReadAgainAsItWasWritten) {
  const std::string folder = test::data("");
  const test::TemporaryFolder here;
  for (const char* name : {"mocap_files/cmu/01_01.bvh", "bvh_dialects/bvh_toolbox/test_freebvh.bvh",
                           "bvh_dialects/pymo/AV_8Walk_Meredith_HVHA_Rep1.bvh"}) {
    if (!fs::exists(folder + name)) GTEST_SKIP() << folder + name << " is not here";
    for (const char* order : {"ZXY", "ZYX", "XYZ"}) {
      SCOPED_TRACE(std::string(name) + " as " + order);
      const SkeletonFile file = read_skeleton(folder + name);
      const std::string path = here / "again.bvh";
      write_again(file, *create_bvh(path, {.unit_m = 0.01, .up = UpAxis::y, .order = order}));
      const SkeletonFile again = read_skeleton(path);
      ASSERT_EQ(again.motion->rows.size(), file.motion->rows.size());
      EXPECT_NEAR(again.motion->rate_hz, file.motion->rate_hz, 1e-3);
      double worst = 0;
      for (std::size_t r = 0; r < file.motion->rows.size(); r += 7) {
        const auto before = pose_of(file.skeleton, file.motion->rows[r]), after = pose_of(again.skeleton, again.motion->rows[r]);
        for (std::size_t s = 0; s < before.size(); ++s) {
          const auto same = static_cast<std::size_t>(again.skeleton.segment(file.skeleton.segments[s].name).value());
          worst = std::max(
              {worst, 100 * (before[s].translation - after[same].translation).norm(),
               geometry::angle_axis_of(before[s].rotation.transpose() * after[same].rotation).norm() * 180 / std::numbers::pi});
        }
      }
      EXPECT_LT(worst, 1e-3) << "units, degrees";
    }
  }
}

TEST(Bvh, AnglesFollowOnWhereTheyPassHalfATurn) {
  const SkeletonFile file = parse_bvh(
      "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n}\nMOTION\nFrames: 3\nFrame Time: 0.01\n170 "
      "80 5\n180 90 5\n190 100 5\n",
      "turn.bvh");
  const test::TemporaryFolder here;
  write_again(file, *create_bvh(here / "turn.bvh", {}));
  const SkeletonFile again = read_skeleton(here / "turn.bvh");
  const auto turn = static_cast<std::size_t>(again.skeleton.coordinate("a_Zrotation").value());
  for (std::size_t r = 1; r < 3; ++r) EXPECT_LT(std::abs(again.motion->rows[r][turn] - again.motion->rows[r - 1][turn]), 0.4);
}

TEST(Glb, IsOneWholeFileWithASkin) {
  const SkeletonFile file = parse_bvh(
      "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nJOINT b\n{\nOFFSET 0 10 0\nCHANNELS 3 "
      "Zrotation Xrotation "
      "Yrotation\nEnd Site\n{\nOFFSET 0 5 0\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.01\n0 0 0 0 0 0\n10 0 0 0 20 0\n",
      "two.bvh");
  const test::TemporaryFolder here;
  write_again(file, *create_glb(here / "two.glb"));
  const std::string bytes = test::read_file(here / "two.glb");
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  };
  ASSERT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(word(4), 2U);
  EXPECT_EQ(word(8), bytes.size());
  const std::string json = bytes.substr(20, word(12));
  EXPECT_EQ(word(20 + word(12)) + 28 + word(12), bytes.size()) << "what follows is one buffer";
  EXPECT_NE(json.find("\"joints\":[0,1]"), std::string::npos) << json;
  EXPECT_NE(json.find("\"path\":\"rotation\""), std::string::npos);
}

TEST(Bvh, SaysWhereItIsWrong) {
  const std::string joint = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n";
  const std::string motion = "}\nMOTION\nFrames: 2\nFrame Time: 0.01\n";
  const auto error = [](const std::string& text) { return error_of([&] { parse_bvh(text, "x.bvh"); }); };
  EXPECT_EQ(error("MOTION\n"), "x.bvh:1: a BVH file begins with HIERARCHY");
  EXPECT_NE(error(joint).find("cut off"), std::string::npos);
  EXPECT_NE(error(joint + motion + "1 2 3\n1 2\n").find("x.bvh:11: 2 numbers; the hierarchy has 3 channels"), std::string::npos);
  EXPECT_NE(error(joint + motion + "1 2 nan\n").find("is no number"), std::string::npos);
  EXPECT_NE(error("HIERARCHY\nROOT a\n{\nOFFSET 0 0\n").find("x.bvh:4"), std::string::npos);
  EXPECT_NE(error("HIERARCHY\nROOT a\n{\nCHANNELS 9 Zrotation\n").find("0 to 6"), std::string::npos);
  const SkeletonFile cut = parse_bvh(joint + motion + "1 2 3\n4 5", "x.bvh");
  EXPECT_EQ(cut.motion->rows.size(), 1U);
  EXPECT_EQ(cut.warnings.size(), 2U) << "the row, and that one was announced";
  EXPECT_FALSE(parse_bvh(joint + "}\n", "x.bvh").motion);
}

TEST(Osim, ReadsModelsOfThreeVersions) {
  const std::string folder = test::data("");
  struct Model {
    const char* name;
    std::size_t segments, coordinates, markers;
  };
  for (const Model& model : {Model{"opensim_ik/synthetic/subject01_simbody.osim", 12, 23, 39},
                             {"opensim_models/hamner/reference/subject02_registered.osim", 20, 37, 0},
                             {"arnold_synthetic/subject01/scaled.osim", 22, 33, 64}}) {
    if (!fs::exists(folder + model.name)) GTEST_SKIP() << folder + model.name << " is not here";
    SCOPED_TRACE(model.name);
    const SkeletonFile file = read_skeleton(folder + model.name);
    EXPECT_EQ(file.skeleton.segments.size(), model.segments);
    EXPECT_EQ(file.skeleton.coordinates.size(), model.coordinates);
    if (model.markers > 0) {
      EXPECT_EQ(file.skeleton.markers.size(), model.markers);
    }
  }
}

std::string osim(const std::string& joints, const std::string& rest = {}) {
  return "<OpenSimDocument Version=\"40000\"><Model name=\"m\"><JointSet><objects>" + joints + "</objects></JointSet>" + rest +
         "</Model></OpenSimDocument>";
}

std::string joint(const std::string& kind, const std::string& parent, const std::string& child,
                  const std::string& coordinates = {}) {
  return "<" + kind + " name=\"" + child + "_joint\"><socket_parent_frame>" + parent +
         "</socket_parent_frame><socket_child_frame>" + child + "</socket_child_frame><coordinates>" + coordinates +
         "</coordinates></" + kind + ">";
}

TEST(Osim, NamesWhatMovesNothing) {
  const std::string one = joint("WeldJoint", "ground", "a");
  EXPECT_EQ(parse_osim(osim(one), "m.osim").unused, "");
  const std::string forces =
      "<ForceSet><objects><Thelen2003Muscle name=\"x\"/><Millard2012EquilibriumMuscle name=\"y\"/><BushingForce "
      "name=\"z\"/></objects></ForceSet><BodySet><objects><Body name=\"a\"><WrapObjectSet><objects><WrapCylinder "
      "name=\"w\"/></objects></WrapObjectSet></Body></objects></BodySet>";
  EXPECT_EQ(parse_osim(osim(one, forces), "m.osim").unused, "2 muscles, 1 other force, 1 wrapping surface");
}

TEST(Osim, RefusesWhatItDoesNotKnow) {
  const auto error = [](const std::string& text) { return error_of([&] { parse_osim(text, "m.osim"); }); };
  EXPECT_NE(error(osim(joint("EllipsoidJoint", "ground", "a"))).find("\"EllipsoidJoint\", which Marey does not know"),
            std::string::npos);
  EXPECT_NE(error(osim(joint("WeldJoint", "b", "a") + joint("WeldJoint", "a", "b"))).find("a circle"), std::string::npos);
  EXPECT_NE(error(osim(joint("PinJoint", "ground", "a"))).find("has 0 coordinates"), std::string::npos);
  EXPECT_NE(error("<a><b></a>").find("is not XML"), std::string::npos);
  const SkeletonFile file =
      parse_osim(osim(joint("PinJoint", "ground", "a", "<Coordinate name=\"q\"><locked>true</locked></Coordinate>"),
                      "<ConstraintSet><objects><PointConstraint name=\"p\"/></objects></ConstraintSet>"),
                 "m.osim");
  EXPECT_TRUE(file.skeleton.coordinates.at(0).locked);
  ASSERT_EQ(file.warnings.size(), 1U);
  EXPECT_NE(file.warnings[0].find("PointConstraint"), std::string::npos);
}

TEST(SkeletonToml, ComesBackAsItWas) {
  const SkeletonFile file = parse_toml(R"(name = "leg"
[[segment]]
name = "thigh"
[[segment]]
name = "shank"
parent = "thigh"
at = [0, 0, -0.4]
turned = [0, 10, 0]
joint = "hinge"
axes = ["-y"]
coordinates = ["knee"]
limits = [-5, 150]
end = [0, 0, -0.4]
[[marker]]
name = "KNE"
on = "shank"
at = [0.05, 0, 0]
)",
                                       "leg.toml");
  EXPECT_EQ(file.skeleton.coordinates.size(), 7U);
  EXPECT_NEAR(*file.skeleton.coordinates[6].highest, 150 * std::numbers::pi / 180, 1e-12);
  const std::string text = to_toml(file.skeleton);
  EXPECT_EQ(to_toml(parse_toml(text, "again.toml").skeleton), text);
}

TEST(SkeletonToml, TellsAllThatIsWrong) {
  const std::string error = error_of([] {
    parse_toml("[[segment]]\nname = \"a\"\njoint = \"knee\"\n[[marker]]\nname = \"m\"\non = \"b\"\nat = [0, 0]\n", "s.toml");
  });
  EXPECT_NE(error.find("s.toml:3"), std::string::npos) << error;
  EXPECT_NE(error.find("on must be a segment"), std::string::npos) << error;
}

TEST(MotionTable, ReadsWhatOthersWrite) {
  const MotionTable table =
      parse_motion_table("walk\nversion=1\nnRows=2\ninDegrees=yes\nendheader\ntime\tknee\n0.0\t1\n0.1\tNaN\n", "walk.mot");
  EXPECT_EQ(table.title, "walk");
  EXPECT_EQ(table.in_degrees, true);
  EXPECT_EQ(table.rows.at(0).at(0), 1);
  EXPECT_FALSE(table.rows.at(1).at(0));
  EXPECT_NE(error_of([] { parse_motion_table("a\nendheader\ntime x\n0 1 2\n", "w"); }).find("w:4"), std::string::npos);
  EXPECT_NE(error_of([] { parse_motion_table("a\n", "w"); }).find("endheader"), std::string::npos);
}

}  // namespace
}  // namespace marey::format::skeleton
