#include "marey/format/rig/rig_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "marey/core/error.h"

#include "support/files.h"
#include "support/text.h"

namespace marey::format::rig {
namespace {

const std::string kExample = R"([world]
up = "z"                                   # metres, right-handed
[[camera]]
name = "left"
source = "left_camera.mp4"                 # or detections = "left.txt"; region = [x, y, width, height]; rate = 25.0
offset_s = 0.25                            # add to this camera's times to get the rig's
size = [3072, 1728]
model = "brown"                            # brown | fisheye | tsai
focal = [2123.1, 2123.1]
principal = [1642.7, 875.7]
distortion = [-0.348, 0.124, 0.0, 0.0, -0.014]
rotation = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]   # camera_from_world
translation = [0.0, 0.0, 5.0]
[[camera]]
name = "far"
size = [640, 480]
ground_from_image = [[0.1, 0, -3], [0, 0.1, 2], [0, 0.001, 1]]
)";

std::string problems_of(const std::string& text) {
  try {
    parse_rig(text, "rig.toml");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == std::string::npos) ADD_FAILURE() << from << " is not there";
  return text.replace(at, from.size(), to);
}

const std::string kCrowned =
    "[world.ground]\ncentre = [52.5, -34.0]\nhalf_size = [52.5, 34.0]\ncrown_across = 0.15\ncrown_along = 0.2\nridge = 0.25\n";

TEST(RigFile, KeepsACrownedGround) {
  EXPECT_TRUE(parse_rig(kExample, "rig.toml").ground.flat());
  EXPECT_EQ(rig_text(parse_rig(kExample, "rig.toml")).find("ground]"), std::string::npos) << "a level one is not written";
  const Rig rig = parse_rig(replaced(kExample, "[[camera]]", kCrowned + "[[camera]]"), "rig.toml");
  EXPECT_EQ(rig.ground.middle, Vector<2>(52.5, -34));
  EXPECT_EQ(rig.ground.half, Vector<2>(52.5, 34));
  EXPECT_EQ(rig.ground.terms(), (std::array<double, 4>{0.15, 0.2, 0, 0.25}));
  const Rig again = parse_rig(rig_text(rig), "rig.toml");
  EXPECT_EQ(again.ground.terms(), rig.ground.terms());
  EXPECT_EQ(again.ground.middle, rig.ground.middle);
  const GroundView view = again.cameras[0].ground_view(again.ground).value();
  EXPECT_EQ(view.surface().height({52.5, -34}), rig.ground.height({52.5, -34}));
}

TEST(RigFile, ReadsTheKeysOfEarlierVersions) {
  const std::string earlier =
      "[world.ground]\nmiddle = [52.5, -34.0]\nhalf = [52.5, 34.0]\nacross = 0.15\nalong = 0.2\ndome = 0.1\nridge = 0.25\n";
  const Rig rig = parse_rig(replaced(kExample, "[[camera]]", earlier + "[[camera]]"), "rig.toml");
  EXPECT_EQ(rig.ground.middle, Vector<2>(52.5, -34));
  EXPECT_EQ(rig.ground.half, Vector<2>(52.5, 34));
  EXPECT_EQ(rig.ground.terms(), (std::array<double, 4>{0.15, 0.2, 0.1, 0.25}));
  EXPECT_NE(rig_text(rig).find("crown_dome = 0.1"), std::string::npos);
  EXPECT_NE(problems_of(replaced(kExample, "[[camera]]", replaced(earlier, "along", "crown_along = 0.2\nalong") + "[[camera]]"))
                .find("ground: along is the earlier name of crown_along; keep one of them"),
            std::string::npos);
  EXPECT_NE(problems_of(replaced(kExample, "name = \"far\"", "name = \"far\"\nmiddle = [1, 2]")).find("unknown key \"middle\""),
            std::string::npos)
      << "in a table that never had it";
}

TEST(RigFile, AGroundThatIsNoneIsRefused) {
  const auto reported = [](const std::string& from, const std::string& to) {
    return problems_of(replaced(kExample, "[[camera]]", replaced(kCrowned, from, to) + "[[camera]]"));
  };
  EXPECT_NE(reported("crown_across = 0.15", "crown_across = 50")
                .find("rig.toml:6: ground: crown_across is 50 m; a pitch is raised by at most 2 m"),
            std::string::npos);
  for (const char* value : {"nan", "inf", "-inf", "1e300", "\"much\"", "[1]"})
    EXPECT_NE(reported("crown_along = 0.2", fmt::format("crown_along = {}", value)).find("crown_along must be a finite number"),
              std::string::npos)
        << value;
  EXPECT_NE(reported("half_size = [52.5, 34.0]", "half_size = [52.5, 0.0]").find("must be 10 to 500 m"), std::string::npos);
  EXPECT_NE(reported("half_size = [52.5, 34.0]\n", "").find("half_size is missing"), std::string::npos);
  EXPECT_NE(reported("centre = [52.5, -34.0]", "centre = [nan, 0]").find("centre must be [x, y] in m"), std::string::npos);
  EXPECT_NE(reported("ridge = 0.25", "ridge = 1.5").find("ridge is 1.5"), std::string::npos);
  EXPECT_NE(reported("ridge = 0.25", "bump = 1").find("unknown key \"bump\""), std::string::npos);
  EXPECT_NE(problems_of(replaced(kExample, "[[camera]]", "ground = 3\n[[camera]]")).find("ground must be a table"),
            std::string::npos);
}

TEST(RigFile, ReadsTheExample) {
  const Rig rig = parse_rig(kExample, "rig.toml");
  ASSERT_EQ(rig.cameras.size(), 2u);
  const RigCamera& left = rig.cameras[0];
  EXPECT_EQ(left.name, "left");
  EXPECT_EQ(left.source, "left_camera.mp4");
  EXPECT_EQ(left.offset_s, 0.25);
  EXPECT_EQ(left.size, cv::Size(3072, 1728));
  const auto& lens = std::get<geometry::BrownLens>(left.lens.value());
  EXPECT_EQ(lens.focal, Vector<2>(2123.1, 2123.1));
  EXPECT_EQ(lens.distortion[4], -0.014);
  EXPECT_EQ(left.camera_from_world->translation, Vector<3>(0, 0, 5));
  EXPECT_TRUE(left.camera());
  EXPECT_FALSE(rig.cameras[1].offset_s) << "not specified";
  EXPECT_FALSE(rig.cameras[1].camera());
  EXPECT_TRUE(rig.cameras[1].ground_view({}));
}

constexpr const char* kWrittenRig = R"([world]
up = "z"                                   # metres, right-handed
# ground_from_world: the ground as its user counts it, of (x, y, 1)
ground_from_world = [[1.0, 0.0, 0.0],
                     [0.0, -1.0, 0.0],
                     [0.0, 0.0, 1.0]]

[calibration]
method = "wand \"3\""
mean_px = 0.1
rms_px = 0.125
inliers = 10
observations = 12
grade = "good"

[[camera]]
name = "left"
source = "left_camera.mp4"                 # seen from this file
region = [0, 5, 3072, 1728]                # x, y, width, height in px
rate = 25.0                                # Hz
offset_s = 0.25                            # add to this camera's times to get the rig's
size = [3072, 1728]                        # px
model = "brown"                            # brown | fisheye | tsai
focal = [2123.1, 2123.1]                   # px
principal = [1642.7, 875.7]                # px; a pixel's whole number is its centre
distortion = [-0.348, 0.124, 0.0, 0.0, -0.014]
# rotation: camera_from_world (a camera has x right, y down, z ahead)
rotation = [[1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0]]
translation = [0.0, 0.0, 5.0]              # m, in the camera's frame

[[camera]]
name = "far"
size = [640, 480]
ground_from_image = [[0.1, 0.0, -3.0],
                     [0.0, 0.1, 2.0],
                     [0.0, 0.001, 1.0]]
rms_px = 0.25
)";

TEST(RigFile, IsWrittenInItsOwnLayoutAndReadsBackTheSame) {
  Rig rig = parse_rig(kExample, "rig.toml");
  rig.calibration =
      Rig::Calibration{.method = "wand \"3\"", .mean_px = 0.1, .rms_px = 0.125, .inliers = 10, .observations = 12, .grade = "good"};
  rig.ground_from_world = Eigen::Vector3d(1, -1, 1).asDiagonal();
  rig.cameras[0].region = cv::Rect(0, 5, 3072, 1728);
  rig.cameras[0].rate_hz = 25;
  rig.cameras[1].rms_px = 0.25;
  const std::string text = rig_text(rig);
  EXPECT_EQ(rig_text(parse_rig(text, "again")), text);
  EXPECT_EQ(text, kWrittenRig);
}

TEST(RigFile, TellsAllProblemsAtOnceEachWithItsLine) {
  std::string text = replaced(kExample, "focal = [2123.1", "focal = [0");
  text = replaced(text, "name = \"far\"", "name = \"left\"\nfocul = 3");
  text = replaced(text, "0, 0, 1]]   #", "0, 0, -1]]   #");
  text = replaced(text, "up = \"z\"", "up = \"x\"");
  EXPECT_EQ(
      problems_of(text),
      "rig.toml:2: world: up is \"x\"; it must be \"z\" or \"y\"\n"
      "rig.toml:9: camera \"left\": focal length is 0; it must be positive\n"
      "rig.toml:12: camera \"left\": rotation is a mirroring (its determinant is -1); it must be a rotation\n"
      "rig.toml:15: camera \"left\": another camera has this name; each needs its own\n"
      "rig.toml:16: camera \"left\": unknown key \"focul\"; there are: name, source, detections, region, rate, offset_s, size, "
      "model, focal, principal, distortion, rotation, translation, ground_from_image, rms_px, ptz, pivot, axis_tilt, nodal_offset, "
      "radial, exposure, gain, masks, threshold");
}

TEST(RigFile, KeepsHowALiveCameraIsSet) {
  Rig rig = parse_rig(kExample, "rig.toml");
  rig.cameras[1].exposure_ms = 2.5;
  rig.cameras[1].gain = 0;
  rig.cameras[1].threshold = 80;
  rig.cameras[1].masks = {{0, 5, 20, 10}, {100, 200, 3, 4}, Mask::polygon({{1, 2}, {30, 4}, {5, 60}})};
  const std::string text = rig_text(rig);
  EXPECT_NE(text.find("masks = [[0, 5, 20, 10], [100, 200, 3, 4], [1, 2, 30, 4, 5, 60]]\n"), std::string::npos) << text;
  const Rig again = parse_rig(text, "again");
  EXPECT_EQ(again.cameras[1].exposure_ms, 2.5);
  EXPECT_EQ(again.cameras[1].gain, 0.0);
  EXPECT_EQ(again.cameras[1].threshold, 80.0);
  EXPECT_EQ(again.cameras[1].masks, rig.cameras[1].masks);
  EXPECT_TRUE(again.cameras[0].masks.empty());
}

TEST(RigFile, HowNoCameraCanBeSetIsRefused) {
  const auto reported = [](const std::string& line) {
    return problems_of(replaced(kExample, "name = \"far\"", "name = \"far\"\n" + line));
  };
  EXPECT_NE(reported("exposure = 0").find("exposure is 0; it must be positive"), std::string::npos);
  EXPECT_NE(reported("gain = -1").find("gain is -1; it must not be negative"), std::string::npos);
  EXPECT_NE(reported("threshold = -1").find("threshold is -1"), std::string::npos);
  EXPECT_NE(reported("masks = [[1, 2, 3]]")
                .find("masks must be [[x, y, width, height], …] in px, a polygon its corners [x, y, x, y, x, y, …], 256 at most"),
            std::string::npos);
  EXPECT_NE(reported("masks = [[1, 2, 3, 4, 5]]").find("masks is [1, 2, 3, 4, 5]; it must be"), std::string::npos);
  EXPECT_NE(reported("masks = [[1, 2, 3, 4, 5, 6.5]]").find("or 3 to 64 corners of a polygon"), std::string::npos);
  EXPECT_NE(reported("masks = 3").find("masks must be"), std::string::npos);
  EXPECT_NE(reported("masks = [[1, 2, 0, 3]]").find("masks is [1, 2, 0, 3]; it must be whole px"), std::string::npos);
  std::string many = "[1, 2, 3, 4]";
  for (int i = 0; i < 256; ++i) many += ", [1, 2, 3, 4]";
  EXPECT_NE(reported("masks = [" + many + "]").find("256 at most"), std::string::npos);
}

TEST(RigFile, AcceptsMissingOptionalKeys) {
  const Rig rig =
      parse_rig("[[camera]]\nname = \"a\"\nfocal = [900, 900]\nprincipal = [320, 240]\n[[camera]]\nname = \"b\"\n", "rig.toml");
  EXPECT_TRUE(rig.cameras[0].lens);
  EXPECT_FALSE(rig.cameras[0].size);
  EXPECT_FALSE(rig.cameras[1].lens);
}

TEST(RigFile, RefusesWhatIsWrong) {
  const auto reported = [](const std::string& from, const std::string& to, const std::string& expected) {
    const std::string problems = problems_of(replaced(kExample, from, to));
    EXPECT_NE(problems.find(expected), std::string::npos) << "\"" << problems << "\" does not specify \"" << expected << "\"";
  };
  reported("[640, 480]", "[640, 0]", ":16: camera \"far\": size is [640, 0]; both must be positive whole numbers of px");
  reported("[640, 480]", "[640.5, 480]", "positive whole numbers");
  reported("[640, 480]", "[640]", "size must be [width, height] in px");
  reported("[0, 0.001, 1]", "[0, 0, 0]", "ground_from_image is singular");
  reported("[0, 0.001, 1]", "[0, 1]", "three rows of three");
  reported("[0, 0.001, 1]", "[0, nan, 1]", "finite");
  reported("[0, 1, 0]", "[0, 1.1, 0]", "not a rotation");
  reported("translation", "translatoin", "translation is missing");
  reported("\"brown\"", "\"browne\"", "model \"browne\" is unknown");
  reported("\"brown\"", "\"tsai\"", "distortion must be at most 1 finite numbers");
  reported("name = \"far\"", "", "camera 2: its name is missing");
  reported("\"far\"", "\"a/b\"", "its name may hold no");
  reported("\"far\"", "7", "name must be a text in quotation marks");
  reported("principal = [1642.7, 875.7]", "", "without its principal point");
  reported("offset_s = 0.25", "offset_s = inf", "offset_s must be a finite number");
  reported("offset_s = 0.25", "rate = -1", "rate is -1; it must be positive");
  reported("offset_s = 0.25", "region = [0, 0, 10, 10]", "they must agree");
  reported("offset_s = 0.25", "detections = \"a.txt\"", "both a source and detections");
  reported("[world]", "[wolrd]", "rig.toml:1: unknown key \"wolrd\"");
  reported("[[camera]]", "[[camera]", "rig.toml:3: ");
  EXPECT_NE(problems_of("").find("there is no camera"), std::string::npos);
  EXPECT_NE(problems_of("camera = 3").find("[[camera]]"), std::string::npos);
  EXPECT_NE(problems_of("camera = [3]").find("[[camera]]"), std::string::npos);
  EXPECT_NE(problems_of("world = 3\ncalibration = 4").find("calibration must be a table"), std::string::npos);
}

TEST(RigFile, AWorldWithYUpIsTurned) {
  const Rig up_y = parse_rig(replaced(kExample, "up = \"z\"", "up = \"y\""), "rig.toml");
  const Rig up_z = parse_rig(kExample, "rig.toml");
  const Vector<3> in_y_up(0.4, 1.5, -2), in_z_up(0.4, 2, 1.5);  // the same place, 1.5 m above the floor
  EXPECT_LT((*up_y.cameras[0].camera_from_world * in_z_up - *up_z.cameras[0].camera_from_world * in_y_up).norm(), 1e-15);
  EXPECT_NEAR(up_y.cameras[0].camera_from_world->rotation.determinant(), 1, 1e-15);
}

TEST(RigFile, ARoundedRotationIsMadeExact) {
  const Rig rig =
      parse_rig(replaced(kExample, "[[1, 0, 0], [0, 1, 0], [0, 0, 1]]", "[[0.7071, -0.7071, 0], [0.7071, 0.7071, 0], [0, 0, 1]]"),
                "rig.toml");
  const Matrix<3>& R = rig.cameras[0].camera_from_world->rotation;
  EXPECT_LT((R.transpose() * R - Matrix<3>::Identity()).norm(), 1e-14);
  EXPECT_NEAR(R(0, 0), std::sqrt(0.5), 1e-14);
}

TEST(RigFile, SourcesLieBesideTheFile) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder / "a");
  test::write_file(folder / "a/rig.toml", kExample);
  Rig rig = read_rig(folder / "a/rig.toml");
  EXPECT_EQ(rig.cameras[0].source, folder / "a/left_camera.mp4");
  write_rig(rig, folder / "out.toml");
  EXPECT_NE(test::read_file(folder / "out.toml").find("source = \"a/left_camera.mp4\""), std::string::npos);
  EXPECT_EQ(read_rig(folder / "out.toml").cameras[0].source, folder / "a/left_camera.mp4");
  EXPECT_THROW(read_rig(folder / "none.toml"), Error);
  EXPECT_THROW(read_rig(folder.path()), Error);
}

TEST(RigFile, AVideoIsNamedAsOne) {
  const std::string text(
      "\0\0\0\x20"
      "ftypisom[[[",
      15);
  try {
    parse_rig(text, "left.mp4", "");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string_view(error.what()).find("left.mp4: is a binary file, as videos are; a rig file is wanted here"),
              std::string_view::npos)
        << error.what();
  }
}

TEST(RigFile, RejectsDeepNestingBeforeParsing) {
  for (const std::string& text : {"a" + test::repeated(".a", 50'000) + " = 1", "[a" + test::repeated(".a", 50'000) + "]",
                                  "a = " + test::repeated("[", 200'000), "a = " + test::repeated("{a=", 50'000)}) {
    EXPECT_NE(problems_of(kExample + text).find("nested more than"), std::string::npos);
  }
}

}  // namespace
}  // namespace marey::format::rig
