#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/format.h"
#include "marey/format/register.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::format::rig {
namespace {

/// The message about the rig at `path`; nothing if it is read.
std::string stated_of(const std::string& path) {
  try {
    format_to_read(path, Content::rig).read_rig(path);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

constexpr const char* kOrientation = R"(105.2632 102.7458 403.8822
  -0.2383291  0.2442810 0.0552577

  0.9688305  -0.0535899  0.2418587
  -0.0033422  0.9734041  0.2290704
  -0.2477021  -0.2227388  0.9428845

  -0.9 0.35
  60.0

  0.0001 0.0001 150.0
)";

/// A working folder of one camera.
class PtvFolder : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "parameters");
    std::filesystem::create_directories(folder_ / "cal");
    write_control("1\n1\n1\n");
    test::write_file(folder_ / "cal/cam1.tif.ori", kOrientation);
  }
  void write_control(const std::string& indices, const std::string& size = "1280\n1024\n0.012\n0.013\n") {
    test::write_file(folder_ / "parameters/ptv.par",
                     "1\nimg/cam1.100\r\ncal\\cam1.tif\r\n1\n0\n1\n" + size + "0\n" + indices + "5\n");
  }
  Rig read(const std::string& name = "") {
    const std::string path = name.empty() ? folder_.path() : folder_ / name;
    return format_to_read(path, Content::rig).read_rig(path);
  }

  test::TemporaryFolder folder_;
};

TEST_F(PtvFolder, IsReadByFolderControlFileAndOrientation) {
  for (const char* name : {"", "parameters/ptv.par", "cal/cam1.tif.ori"}) {
    const Rig rig = read(name);
    ASSERT_EQ(rig.cameras.size(), 1U) << name;
    const RigCamera& camera = rig.cameras.front();
    EXPECT_EQ(camera.name, "cam1");
    EXPECT_EQ(camera.size, cv::Size(1280, 1024));
    const auto& lens = std::get<geometry::BrownLens>(camera.lens.value());
    EXPECT_NEAR(lens.focal.x(), 5000, 1e-9);
    EXPECT_NEAR(lens.focal.y(), 60 / 0.013, 1e-9);
    EXPECT_LT((lens.principal - Vector<2>(639.5 - 75, 511.5 - 0.35 / 0.013)).norm(), 1e-9);
    const Vector<3> centre = camera.camera()->centre();
    EXPECT_LT((centre - Vector<3>(0.1052632, 0.1027458, 0.4038822)).norm(), 1e-7);
    const auto middle = camera.camera()->project({0, 0, 0});
    ASSERT_TRUE(middle) << "it faces along its -z, where the origin is";
  }
}

TEST_F(PtvFolder, ReadsBrownDistortion) {
  test::write_file(folder_ / "cal/cam1.tif.addpar", "0.0003 -0.00001 0.0000002 0.0005 -0.0004 1.002 0");
  EXPECT_TRUE(contains(read().calibration->method, "lenses to 0.")) << "it bends about a place beside its principal point";
  std::string ideal = kOrientation;
  ideal.replace(ideal.find("-0.9 0.35"), 9, " 0.0 0.00");
  test::write_file(folder_ / "cal/cam1.tif.ori", ideal);
  const Rig rig = read();
  EXPECT_EQ(rig.calibration->method, "OpenPTV");
  const auto& lens = std::get<geometry::BrownLens>(rig.cameras.front().lens.value());
  EXPECT_NEAR(lens.focal.x(), 1.002 * 5000, 1e-9);
  EXPECT_NEAR(lens.distortion[0], 0.0003 * 3600, 1e-12);
  EXPECT_NEAR(lens.distortion[2], 0.0004 * 60, 1e-12) << "y is down here";
  EXPECT_NEAR(lens.distortion[3], 0.0005 * 60, 1e-12);
  test::write_file(folder_ / "cal/cam1.tif.addpar", "0.0003 -0.00001 0.0000002 0.0005 -0.0004 1.002 0.3");
  EXPECT_TRUE(contains(stated_of(folder_.path()), "no Brown lens stands for its shear of 0.3 rad"));
}

TEST_F(PtvFolder, RaysThatBendAreRefused) {
  write_control("1\n1.46\n1.33\n");
  const std::string message = stated_of(folder_.path());
  EXPECT_TRUE(contains(message, "refractive indices 1, 1.46 and 1.33")) << message;
  EXPECT_TRUE(contains(message, "ptv.par")) << message;
}

TEST_F(PtvFolder, BadFilesAreNamedInOneSentence) {
  const auto problem = [&] { return stated_of(folder_.path()); };
  write_control("1\n1\n1\n", "0\n1024\n0.012\n0.013\n");
  EXPECT_TRUE(contains(problem(), "are not any"));
  write_control("1\n1\n1\n", "1280\n1024\n0.012\nnan\n");
  EXPECT_TRUE(contains(problem(), "ptv.par:10: the size of a pixel is \"nan\"")) << problem();
  test::write_file(folder_ / "parameters/ptv.par", "1000000\n");
  EXPECT_TRUE(contains(problem(), "1000000")) << problem();
  test::write_file(folder_ / "parameters/ptv.par", "2\nimg/cam1.100\ncal/cam1.tif\n");
  EXPECT_TRUE(contains(problem(), "ends before all cameras are named")) << problem();
  test::write_file(folder_ / "parameters/ptv.par", "1\nimg/cam1.100\ncal/\x1b[2J.tif\n");
  EXPECT_TRUE(contains(problem(), "control characters in the name of camera 1's")) << problem();
  write_control("1\n1\n1\n");
  test::write_file(folder_ / "cal/cam1.tif.ori", "1 2 3\n4 5 6\n");
  EXPECT_TRUE(contains(problem(), "6 numbers, and an OpenPTV orientation has 18 or more")) << problem();
  test::write_file(folder_ / "cal/cam1.tif.ori", std::string(kOrientation) + "glass\n");
  EXPECT_TRUE(contains(problem(), "\"glass\" is no number")) << problem();
  std::filesystem::remove(folder_ / "cal/cam1.tif.ori");
  EXPECT_TRUE(contains(problem(), "cam1.tif.ori")) << problem();
}

TEST(OpenPtvRig, TheRealFolderSeesThroughWaterAndIsRefused) {
  const std::string folder = test::data("particles");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not here";
  const std::string message = stated_of(folder);
  EXPECT_TRUE(contains(message, "refractive indices")) << message;
}

}  // namespace
}  // namespace marey::format::rig
