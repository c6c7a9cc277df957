#include "marey/format/rig/imported_rig.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/observations.h"
#include "marey/format/register.h"
#include "marey/format/rig/self_cal_folder.h"

#include "support/data.h"
#include "support/files.h"
#include "support/text.h"

namespace marey::format::rig {
namespace {

/// Two cameras that face the origin from some metres.
const Format& of_rigs(const char* name) {
  return *format_named(name, Content::rig);
}

Rig read_known_rig(const std::string& path) {
  return format_to_read(path, Content::rig).read_rig(path);
}

Rig two_cameras() {
  Rig rig;
  for (int i = 0; i < 2; ++i) {
    RigCamera camera;
    camera.name = i == 0 ? "left" : "right";
    camera.size = cv::Size(1280, 720 + 80 * i);
    geometry::BrownLens lens;
    lens.focal = {900 + 10.5 * i, 905};
    lens.principal = {630.25, 371 + 20 * i};
    lens.distortion = {-0.12, 0.03, 4e-4, -3e-4};
    camera.lens = lens;
    const Matrix<3> upright = Matrix<3>{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};  // faces along y, z up
    camera.camera_from_world = Rigid3{geometry::rotation_from({0.3, 0.1 * i, 0.02}) * upright, {0.25 - 0.5 * i, 0.4, 3.5 + i}};
    rig.cameras.push_back(camera);
  }
  return rig;
}

/// The farthest that two rigs see the same points apart, px.
double apart(const Rig& a, const Rig& b) {
  double worst = a.cameras.size() == b.cameras.size() ? 0 : 1e9;
  for (std::size_t i = 0; i < std::min(a.cameras.size(), b.cameras.size()); ++i) {
    for (const double x : {-1.0, 0.0, 0.7}) {
      for (const double z : {-0.8, 0.1, 0.9}) {
        const Vector<3> point(x, 0.3 * x - 0.2 * z, z);
        const auto p = a.cameras[i].camera()->project(point), q = b.cameras[i].camera()->project(point);
        worst = std::max(worst, p && q ? (*p - *q).norm() : 1e9);
      }
    }
  }
  return worst;
}

TEST(RigExchange, EveryFormatReadsBackWhatItWrites) {
  const test::TemporaryFolder folder;
  const Rig rig = two_cameras();
  const std::vector<std::pair<const char*, std::string>> formats{{"marey", "a.toml"},       {"opencv", "b.yml"},
                                                                 {"opencv", "c.json"},      {"aniposelib", "d.toml"},
                                                                 {"multicamselfcal", "e/"}, {"qualisys", "f.qca.txt"}};
  for (const auto& [format, name] : formats) {
    of_rigs(format).write_rig(rig, folder / name);
    EXPECT_EQ(format_of_content(folder / name)->name, format) << name;
    const Rig again = read_known_rig(folder / name);
    EXPECT_EQ(again.cameras[1].name, "right") << name;
    EXPECT_EQ(again.cameras[1].size, cv::Size(1280, 800)) << name;
    EXPECT_LT(apart(rig, again), 1e-6) << name;
  }
  Rig one;
  one.cameras.push_back(rig.cameras[0]);
  one.cameras[0].lens = geometry::TsaiLens{{900, 880}, {640, 360}, {0.08}};
  for (const auto& [format, name, limit] : {std::tuple{"tsai", "g.xml", 1e-6}, std::tuple{"opencv", "h.yml", 0.05}}) {
    of_rigs(format).write_rig(one, folder / name);
    EXPECT_LT(apart(one, read_known_rig(folder / name)), limit) << name;
  }
  one.cameras[0].lens = geometry::FisheyeLens{{700, 710}, {640, 360}, {0.02, -0.01, 0.003, 0.001}};
  for (const auto& [format, name] : {std::pair{"opencv", "i.yml"}, std::pair{"aniposelib", "j.toml"}}) {
    of_rigs(format).write_rig(one, folder / name);
    EXPECT_LT(apart(one, read_known_rig(folder / name)), 1e-6) << name;
  }
}

TEST(RigExchange, ReportsUnsupportedContent) {
  const test::TemporaryFolder folder;
  Rig rig = two_cameras();
  EXPECT_THROW(of_rigs("tsai").write_rig(rig, folder / "a.xml"), Error);
  rig.cameras[0].lens = geometry::FisheyeLens{{400, 400}, {640, 360}, {0.05, 0, 0, 0}};
  EXPECT_THROW(of_rigs("qualisys").write_rig(rig, folder / "a.qca.txt"), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.qca.txt"));
  rig = two_cameras();
  rig.cameras[1].camera_from_world.reset();
  for (const char* format : {"qualisys", "aniposelib", "multicamselfcal"}) {
    EXPECT_THROW(of_rigs(format).write_rig(rig, folder / "b"), Error);
  }
}

TEST(RigExchange, FormatsAreKnownByTheirNames) {
  const auto of_name = [](const char* name) { return format_of_name(name, Content::rig); };
  EXPECT_EQ(of_name("a.qca.txt")->name, "qualisys");
  EXPECT_EQ(of_name("a.yaml")->name, "opencv");
  EXPECT_EQ(of_name("folder/")->name, "multicamselfcal");
  EXPECT_EQ(of_name("a.c3d"), nullptr);
  EXPECT_EQ(format_named("c3d", Content::rig), nullptr);
  const test::TemporaryFolder folder;
  test::write_file(folder / "take", std::string("SQLite format 3\0[[camera]]", 26));
  EXPECT_EQ(format_of_content(folder / "take"), nullptr);
  EXPECT_THROW(read_known_rig(folder / "take"), Error);
  EXPECT_THROW(read_known_rig(folder / "nothing"), Error);
}

TEST(OpenCvRig, ReadsASingleCameraAndAStereoPair) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "one.yml", R"(%YAML:1.0
---
image_width: 640
image_height: 480
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 535.9, 0., 342.2, 0., 536.1, 235.5, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -0.266, -0.0385, 0.00178, -0.000281, 0.238 ]
avg_reprojection_error: 0.39
)");
  const Rig one = read_known_rig(folder / "one.yml");
  EXPECT_EQ(one.cameras[0].size, cv::Size(640, 480));
  EXPECT_EQ(std::get<geometry::BrownLens>(*one.cameras[0].lens).distortion[4], 0.238);
  EXPECT_EQ(one.cameras[0].rms_px, 0.39);
  EXPECT_FALSE(one.cameras[0].camera_from_world);

  const auto matrix = [](const std::string& name, int rows, int cols, const std::string& data) {
    return name + ": !!opencv-matrix\n   rows: " + std::to_string(rows) + "\n   cols: " + std::to_string(cols) +
           "\n   dt: d\n   data: [ " + data + " ]\n";
  };
  const std::string K = "500., 0., 320., 0., 500., 240., 0., 0., 1.";
  test::write_file(folder / "intrinsics.yml", "%YAML:1.0\n---\n" + matrix("M1", 3, 3, K) +
                                                  matrix("D1", 1, 5, "0.1, 0., 0., 0., 0.") + matrix("M2", 3, 3, K) +
                                                  matrix("D2", 1, 5, "0.2, 0., 0., 0., 0."));
  EXPECT_FALSE(read_known_rig(folder / "intrinsics.yml").cameras[1].camera_from_world);
  test::write_file(folder / "extrinsics.yml", "%YAML:1.0\n---\n" + matrix("R", 3, 3, "1., 0., 0., 0., 1., 0., 0., 0., 1.") +
                                                  matrix("T", 3, 1, "-3.3, 0.1, 0.2"));
  const Rig pair = read_known_rig(folder / "intrinsics.yml");
  EXPECT_EQ(pair.cameras[1].camera_from_world->translation, Vector<3>(-3.3, 0.1, 0.2));
  EXPECT_EQ(std::get<geometry::BrownLens>(*pair.cameras[1].lens).distortion[0], 0.2);

  for (const char* bad : {"%YAML:1.0\n---\na: 3\n", "%YAML:1.0\n---\ncamera_matrix: 3\n", "%YAML:1.0\n---\ncamera_matrix: [1, 2\n",
                          "%YAML:1.0\n---\ncamera_matrix: [0, 0, 0, 0, 0, 0, 0, 0, 1]\n", "{\"matrix\": [}"}) {
    test::write_file(folder / "bad.yml", bad);
    EXPECT_THROW(read_known_rig(folder / "bad.yml"), Error) << bad;
  }
}

TEST(AniposelibRig, ReadsTheUnitsThatItsTranslationsAreIn) {
  const test::TemporaryFolder folder;
  const std::string text = R"([cam_0]
name = "A"
size = [ 640, 480,]
matrix = [ [ 500.0, 0.0, 320.0,], [ 0.0, 500.0, 240.0,], [ 0.0, 0.0, 1.0,],]
distortions = [ 0.1, 0.0, 0.0, 0.0, 0.0,]
rotation = [ 0.0, 0.1, 0.0,]
translation = [ 10.0, 20.0, 900.0,]
[metadata]
error = 0.4
)";
  test::write_file(folder / "a.toml", text);
  const Rig rig = read_known_rig(folder / "a.toml");
  EXPECT_EQ(rig.cameras[0].name, "A");
  EXPECT_NEAR(rig.cameras[0].camera_from_world->translation.z(), 0.9, 1e-12);
  EXPECT_NEAR(geometry::angle_axis_of(rig.cameras[0].camera_from_world->rotation).y(), 0.1, 1e-12);
  for (const auto& [from, to] : {std::pair{"500.0, 0.0, 320.0,", "500.0, 0.0,"},
                                 {"[ 0.0, 0.1, 0.0,]", "[ 0.0, 0.1,]"},
                                 {"640, 480", "640"},
                                 {"[cam_0]", "[cam_0"},
                                 {"20.0", "nan"},
                                 {"matrix", "mtx"}}) {
    std::string bad = text;
    bad.replace(bad.find(from), std::string(from).size(), to);
    test::write_file(folder / "b.toml", bad);
    if (std::string(to) == "mtx") {
      EXPECT_FALSE(read_aniposelib_rig(folder / "b.toml").cameras[0].lens);
    } else {
      EXPECT_THROW(read_aniposelib_rig(folder / "b.toml"), Error) << to;
    }
  }
}

TEST(AniposelibRig, ReadsCaliscopesCameras) {
  const std::string path = test::data("charuco_pair/camera_array.toml");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  const Rig rig = read_known_rig(path);
  ASSERT_EQ(rig.cameras.size(), 2u);
  EXPECT_EQ(rig.cameras[0].name, "cam0");
  EXPECT_NEAR((rig.cameras[0].camera()->centre() - rig.cameras[1].camera()->centre()).norm(), 1.132, 0.001)
      << "the stored baseline";
}

TEST(QualisysRig, AxesPointRightUpAndBack) {
  const test::TemporaryFolder folder;
  // A camera 2 m before the origin (at y = -2 m) that faces along y, level.
  const std::string text = R"(<?xml version="1.0"?>
<calibration type="regular"><results std-dev="0.5"/><cameras>
<camera active="1" avg-residual="0.4" serial="22139" model="Miqus M3">
 <fov_marker left="100" top="50" right="1923" bottom="1137"/><fov_video left="0" top="0" right="9" bottom="9"/>
 <transform x="0" y="-2000" z="1000" r11="1" r12="0" r13="0" r21="0" r22="0" r23="1" r31="0" r32="-1" r33="0"/>
 <intrinsic focalLengthU="107599" focalLengthV="107588" centerPointU="64000" centerPointV="38400" skew="0" radialDistortion1="-0.04"
  radialDistortion2="0.1" radialDistortion3="0" tangentalDistortion1="0.0006" tangentalDistortion2="0.0007"/></camera>
<camera active="0" serial="7"/></cameras></calibration>)";
  test::write_file(folder / "a.qca.txt", text);
  const Rig rig = read_known_rig(folder / "a.qca.txt");
  ASSERT_EQ(rig.cameras.size(), 1u) << "the second is not in use";
  EXPECT_EQ(rig.cameras[0].name, "22139");
  EXPECT_EQ(rig.cameras[0].size, cv::Size(1824, 1088));
  const Camera camera = *rig.cameras[0].camera();
  EXPECT_LT((camera.centre() - Vector<3>(0, -2, 1)).norm(), 1e-12);
  EXPECT_LT((*camera.project({0, 0, 1}) - Vector<2>(900, 550)).norm(), 1e-9);
  EXPECT_GT(camera.project({0.5, 0, 1})->x(), 900) << "x is to the right";
  EXPECT_LT(camera.project({0, 0, 1.5})->y(), 550) << "z is up";
  for (const auto& [from, to] : {std::pair{"focalLengthU=\"107599\"", ""},
                                 {"r11=\"1\"", "r11=\"2\""},
                                 {"<transform", "<transfrom"},
                                 {"</calibration>", ""},
                                 {"focalLengthV=\"107588\"", "focalLengthV=\"-1\""},
                                 {"right=\"1923\"", "right=\"x\""}}) {
    std::string bad = text;
    bad.replace(bad.find(from), std::string(from).size(), to);
    test::write_file(folder / "b.qca.txt", bad);
    EXPECT_THROW(read_known_rig(folder / "b.qca.txt"), Error) << from;
  }
}

TEST(TsaiRig, FeetOfBoxesStandWhereTheTruthSays) {
  const std::string path = test::data("pets2009/Tsai_View_001.xml");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  const Rig rig = read_known_rig(path);
  const Camera camera = *rig.cameras[0].camera();
  const GroundView view(camera);
  std::istringstream lines(test::read_file(test::data("pets2009/gt_001_300.txt")));
  Vector<2> sum = Vector<2>::Zero(), worst = Vector<2>::Zero();
  double worst_m = 0;
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    std::vector<double> v;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) v.push_back(std::stod(field));
    ASSERT_EQ(v.size(), 10u);
    // MOTChallenge counts from 1; a box's border lies half a pixel before the centre of its first pixel. Its corner is rounded.
    const Vector<2> foot(v[2] - 1.5 + v[4] / 2, v[3] - 1.5 + v[5]), truth(v[7], v[8]);
    const Vector<2> off = *camera.project({truth.x(), truth.y(), 0}) - foot;
    sum += off;
    worst = worst.cwiseMax(off.cwiseAbs());
    worst_m = std::max(worst_m, (view.location(foot)->ground - truth).norm());
  }
  EXPECT_GT(count, 1000);
  EXPECT_LT((sum / count).norm(), 0.03) << "px: the model and its convention";
  EXPECT_LT(worst.maxCoeff(), 0.55) << "px: what rounding leaves";
  EXPECT_LT(worst_m, 0.1) << "m: half a pixel, far away";
}

/// How far the projections of a folder's rig are from the observations, where its own points in space are known.
double median_error(const std::string& path, bool mirrored) {
  const SelfCalFolder folder(path);
  const Rig rig = read_known_rig(path);
  std::vector<double> errors;
  for (int i = 0; i < folder.cameras(); ++i) {
    const RigCamera& camera = rig.cameras[static_cast<std::size_t>(i)];
    const auto table = read_number_table(path + "/cam" + std::to_string(i + 1) + ".points4cal.dat");
    for (Eigen::Index row = 0; row < table.rows(); ++row) {
      Vector<3> point = table.block<1, 3>(row, 0).transpose() * folder.unit();
      if (mirrored) point.x() = -point.x();
      const auto pixel = camera.camera()->project(point);
      errors.push_back(pixel ? (*pixel - Vector<2>(table.block<1, 2>(row, 4).transpose())).norm() : 1e9);
    }
  }
  std::nth_element(errors.begin(), errors.begin() + std::ssize(errors) / 2, errors.end());
  return errors[errors.size() / 2];
}

TEST(SelfCalRig, MatricesAndLensesAreOneLens) {
  const std::string four = test::data("led_rig_4"), five = test::data("led_rig_5");
  if (!std::filesystem::exists(four)) GTEST_SKIP() << four << " is not here";
  EXPECT_LT(median_error(five, false), 0.28) << "px, where MultiCamSelfCal's own matrices, which have a skew, leave 0.21";
  const Rig rig = read_known_rig(four);
  EXPECT_LT((rig.cameras[0].camera()->centre() - Vector<3>(0.376991, -0.241439, 0.540068)).norm(), 1e-5) << "as basename1.cal says";

  // Without the aligned matrices those of the first reconstruction count, whose world is a mirror image.
  const test::TemporaryFolder folder;
  for (const auto& entry : std::filesystem::directory_iterator(four)) {
    const std::string name = entry.path().filename().string();
    if (name.find("Pmat.cal") == std::string::npos) std::filesystem::copy_file(entry.path(), folder / name);
  }
  EXPECT_LT(median_error(folder.path(), true), 0.56) << "px, where its own matrices leave 0.26";
}

TEST(RigExchange, RejectsDeepNestingBeforeParsing) {
  constexpr int kMany = 200'000;
  const auto refused = [](auto parse, const std::string& text) {
    try {
      parse(text, "file");
    } catch (const Error& error) {
      return std::string_view(error.what()).find("nested more than") != std::string_view::npos;
    }
    return false;
  };
  EXPECT_TRUE(refused(parse_opencv_rig, "%YAML:1.0\n---\na: " + test::repeated("[", kMany)));
  EXPECT_TRUE(refused(parse_opencv_rig, "%YAML:1.0\n---\n" + test::repeated("- ", kMany)));
  EXPECT_TRUE(refused(parse_opencv_rig, "{\"a\": " + test::repeated("[", kMany)));
  EXPECT_TRUE(refused(parse_opencv_rig, "<?xml version=\"1.0\"?>\n<opencv_storage>" + test::repeated("<a>", kMany)));
  EXPECT_TRUE(refused(parse_aniposelib_rig, "[cam_0]\nmatrix" + test::repeated(".a", kMany) + " = 1"));
  EXPECT_TRUE(refused(parse_qualisys_rig, test::repeated("<calibration>", kMany)));
  EXPECT_TRUE(refused(parse_tsai_rig, test::repeated("<Camera>", kMany)));
}

TEST(SelfCalRig, RemarksInALensFileArePassedOver) {
  const test::TemporaryFolder folder;
  const Rig rig = two_cameras();
  of_rigs("multicamselfcal").write_rig(rig, folder / "e/");
  std::ofstream lens(folder / "e/basename1.rad", std::ios::app);
  lens << "comments = 'measured in March, 2 boards'\nnx = 1280 px\n";
  lens.close();
  EXPECT_LT(apart(rig, read_known_rig(folder / "e/")), 1e-6);
  std::ofstream(folder / "e/basename2.rad", std::ios::app) << "K12 = zero\n";
  EXPECT_THROW(read_known_rig(folder / "e/"), Error);
}

TEST(RigExchange, NoMessageShowsALibrarysInternals) {
  const std::string head = "%YAML:1.0\n---\n",
                    matrix = "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 1., 2. ]\n";
  for (const std::string& text :
       {head + matrix, std::string("%YAML:1.0\n---\na: [ 1, }\n"), head + "cameras:\n   - { camera_matrix: 1 }\n",
        std::string("{ \"camera_matrix\": { \"type_id\": \"opencv-matrix\" "), std::string()}) {
    try {
      parse_opencv_rig(text, "file.yml");
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      const std::string stated = error.what();
      EXPECT_TRUE(stated.starts_with("file.yml:")) << stated;
      for (const char* internal : {"nelems", "cv::", "OpenCV(", ".cpp", "persistence", "=="})
        EXPECT_EQ(stated.find(internal), std::string::npos) << stated;
    }
  }
}

TEST(RigExchange, NumbersThatNoRigHoldsAreRefused) {
  for (const char* number : {"1e308", "1e9", "-2e12"}) {
    const std::string text =
        std::string("<?xml version=\"1.0\"?><opencv_storage><camera_matrix type_id=\"opencv-matrix\"><rows>3</rows>") +
        "<cols>3</cols><dt>d</dt><data>600. 0. " + number + " 0. 600. 240. 0. 0. 1.</data></camera_matrix></opencv_storage>";
    EXPECT_THROW(parse_opencv_rig(text, "file.xml"), Error) << number;
  }
}

TEST(RigExchange, RejectsUnsupportedOpenCvContentWithoutFile) {
  const test::TemporaryFolder folder;
  Rig rig = two_cameras();
  rig.cameras[0].name = std::string(5000, 'a');
  EXPECT_THROW(write_opencv_rig(rig, folder / "a.yml"), Error);
  rig.cameras.resize(1);
  rig.cameras[0].name = "a";
  rig.cameras[0].lens.reset();
  EXPECT_THROW(write_opencv_rig(rig, folder / "a.yml"), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(RigExchange, NamesInMessagesArePlain) {
  try {
    parse_qualisys_rig("<calibration><cameras><camera serial=\"a\x11z\"/></cameras></calibration>", "file");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string_view(error.what()).find('\x11'), std::string_view::npos) << error.what();
  }
}

TEST(RigExchange, OpenCvFilesThatAreCutOffAnywhereEndInOneSentence) {
  const test::TemporaryFolder folder;
  const std::string xml =
      "<?xml version=\"1.0\"?>\n<opencv_storage>\n<camera_matrix type_id=\"opencv-matrix\"><rows>3</rows><cols>3</cols><dt>d</dt>\n"
      "<data>600. 0. 320. 0. 600. 240. 0. 0. 1.</data></camera_matrix>\n</opencv_storage>\n";
  for (std::size_t size = 0; size + 1 < xml.size(); ++size)
    EXPECT_THROW(parse_opencv_rig(xml.substr(0, size), "file.xml"), Error) << size;
  write_opencv_rig(two_cameras(), folder / "a.json");
  const std::string json = test::read_file(folder / "a.json");
  for (std::size_t size = 0; size < json.size() - 2; size += 7)
    EXPECT_THROW(parse_opencv_rig(json.substr(0, size), "file.json"), Error) << size;
}

}  // namespace
}  // namespace marey::format::rig
