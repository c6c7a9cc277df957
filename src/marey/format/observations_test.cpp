#include "marey/format/observations.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/rig/self_cal_folder.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::format {
namespace {

Rig two_cameras() {
  Rig rig;
  rig.cameras.resize(2);
  rig.cameras[0].name = "left";
  rig.cameras[1].name = "right";
  return rig;
}

std::string error_of(const std::string& text, const Rig& rig = two_cameras()) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "o.csv", text);
  try {
    read_observations(folder / "o.csv", rig);
  } catch (const Error& error) {
    return std::string(error.what()).substr((folder / "o.csv").size());
  }
  return "";
}

TEST(Observations, AreReadFrameByFrame) {
  const test::TemporaryFolder folder;
  test::write_file(
      folder / "o.csv",
      "camera,frame,x,y,marker\r\nright,0,1.5,2.5,A\r\nleft,0,3,4,\r\n\r\nleft,2,-5,6e1,B\r\nright,3,,,C\r\nleft,7, 1 ,2,B\r\n");
  ObservationReader reader(folder / "o.csv", two_cameras());
  auto frame = reader.next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->frame, 0);
  ASSERT_EQ(frame->points.size(), 2u);
  EXPECT_EQ(frame->points[0].camera, CameraId{0});
  EXPECT_EQ(frame->of(CameraId{1})[0].pixel, Vector<2>(1.5, 2.5));
  EXPECT_EQ(frame->of(CameraId{1})[0].marker, "A");
  frame = reader.next();
  EXPECT_EQ(frame->frame, 2);
  EXPECT_EQ(frame->points[0].pixel, Vector<2>(-5, 60));
  EXPECT_TRUE(frame->of(CameraId{1}).empty());
  EXPECT_EQ(reader.next()->frame, 7) << "a blank place is not seen";
  EXPECT_FALSE(reader.next());
  EXPECT_FALSE(reader.next());
}

TEST(Observations, SortedOrNotAndColumnsInAnyOrderReadTheSame) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.csv",
                   "\xEF\xBB\xBF"
                   "x,y,frame,camera\n1,2,0,left\n5,6,1,left\n3,4,0,right\n7,8,1,right\n");
  const auto frames = read_observations(folder / "a.csv", two_cameras());
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].points[1].pixel, Vector<2>(3, 4));
  EXPECT_EQ(frames[1].points[0].pixel, Vector<2>(5, 6));
  ObservationWriter writer(folder / "b.csv", two_cameras(), false);
  for (const ObservedFrame& frame : frames) writer.write(frame);
  writer.finish();
  EXPECT_EQ(test::read_file(folder / "b.csv"),
            "camera,frame,x,y\nleft,0,1.0000,2.0000\nright,0,3.0000,4.0000\nleft,1,5.0000,6.0000\nright,1,7.0000,8.0000\n");
  EXPECT_EQ(rig_of_observations(folder / "b.csv").cameras[1].name, "right");
}

TEST(Observations, TellWhatIsWrong) {
  EXPECT_EQ(error_of(""), ": the file is empty; it must begin with camera,frame,x,y");
  EXPECT_EQ(error_of("camera,frame,x\n"),
            ":1: there is no column \"y\"; the header must be camera,frame,x,y or camera,frame,x,y,marker");
  EXPECT_EQ(error_of("camera,frame,x,y\nmiddle,0,1,2\n"), ":2: the rig has no camera \"middle\"; there are: left, right");
  EXPECT_EQ(error_of("camera,frame,x,y\nleft,-1,1,2\n"), ":2: frame is \"-1\"; it must be a whole number from 0");
  EXPECT_EQ(error_of("camera,frame,x,y\nleft,1,one,2\n"), ":2: x is \"one\"; it must be a number of px");
  EXPECT_EQ(error_of("camera,frame,x,y\nleft,1,1,inf\n"), ":2: y is \"inf\"; it must be a number of px");
  EXPECT_EQ(error_of("camera,frame,x,y\nleft,1,1\n"), ":2: the row has 3 fields, and none for y");
  EXPECT_THROW(read_observations("/nowhere/o.csv", two_cameras()), Error);
}

/// Three cameras, four instants, of which each camera misses some.
void write_folder(const test::TemporaryFolder& folder) {
  test::write_file(
      folder / "points.dat",
      "# name: points\n1 2 3 NaN\n1 2 3 NaN\n1 1 1 NaN\n11 12 13 14\n11 12 13 14\n1 1 1 1\n21 22 23 24\n21 22 23 24\n1 1 1 1\n");
  test::write_file(folder / "IdMat.dat", "1 1 1 0\n1 0 1 1\n0 1 1 1\n");
  test::write_file(folder / "Res.dat", "640 480\n640 480\n320 240\n");
  test::write_file(folder / "basename2.rad",
                   "K11 = 500\nK12 = 0\nK13 = 320\nK22 = 501\nK23 = 240\nkc1 = -0.2\nkc2 = 0.1\nkc3 = 0\nkc4 = 0.001\n");
}

TEST(SelfCalFolder, HoldsObservationsSizesAndLenses) {
  const test::TemporaryFolder folder;
  write_folder(folder);
  const Rig rig = rig_of_observations(folder.path());
  ASSERT_EQ(rig.cameras.size(), 3u);
  EXPECT_EQ(rig.cameras[2].size, cv::Size(320, 240));
  EXPECT_FALSE(rig.cameras[0].lens);
  EXPECT_EQ(std::get<geometry::BrownLens>(*rig.cameras[1].lens).distortion[3], 0.001);
  const auto frames = read_observations(folder.path(), rig);
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_EQ(frames[1].points.size(), 2u);
  EXPECT_EQ(frames[1].of(CameraId{2})[0].pixel, Vector<2>(22, 22));
  EXPECT_TRUE(frames[1].of(CameraId{1}).empty());
  EXPECT_THROW(read_observations(folder.path(), two_cameras()), Error);
  test::write_file(folder / "camera_order.txt", "c\nb\na\n");
  EXPECT_EQ(rig_of_observations(folder.path()).cameras[0].name, "c");
  Rig other_order = rig_of_observations(folder.path());
  std::swap(other_order.cameras[0], other_order.cameras[2]);
  EXPECT_EQ(read_observations(folder.path(), other_order)[1].of(CameraId{0})[0].pixel, Vector<2>(22, 22));
}

TEST(SelfCalFolder, RowsOfOnePointInSpaceAreOneInstant) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "cam1.points4cal.dat", "1 0 0 1 10 10 1\n2 0 0 1 20 20 1\n4 0 0 1 40 40 1\n");
  test::write_file(folder / "cam2.points4cal.dat", "1 0 0 1 11 11 1\n3 0 0 1 31 31 1\n4 0 0 1 41 41 1\n");
  test::write_file(folder / "cam3.points4cal.dat", "2 0 0 1 22 22 1\n3 0 0 1 32 32 1\n");
  const auto frames = read_observations(folder.path(), rig_of_observations(folder.path()));
  ASSERT_EQ(frames.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(frames[i].frame, static_cast<std::int64_t>(i));
    ASSERT_EQ(frames[i].points.size(), 2u);
    for (const ImageObservation& point : frames[i].points)
      EXPECT_EQ(static_cast<int>(point.pixel.x()) / 10, static_cast<int>(i) + 1);
  }
}

TEST(SelfCalFolder, TellsWhatIsWrong) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(rig_of_observations(folder.path()), Error);
  write_folder(folder);
  const auto broken = [&](const std::string& file, const std::string& text) {
    const std::string before = test::read_file(folder / file);
    test::write_file(folder / file, text);
    EXPECT_THROW(read_observations(folder.path(), rig_of_observations(folder.path())), Error) << file << ": " << text;
    test::write_file(folder / file, before);
  };
  broken("IdMat.dat", "1 1 1\n1 0 1\n0 1 1\n");
  broken("IdMat.dat", "1 1 1 0\n1 0 1\n");
  broken("IdMat.dat", "1 1 1 0\n1 0 1 1\n");
  broken("points.dat", "1 2 three\n");
  broken("points.dat", "");
  broken("Res.dat", "640 480\n");
  broken("Res.dat", "640 480\n640 0\n640 480\n");
  broken("basename2.rad", "K11 = 500\n");
}

TEST(SelfCalFolder, ReadsTheSetsOfLights) {
  const std::string four = test::data("led_rig_4"), five = test::data("led_rig_5");
  if (!std::filesystem::exists(four)) GTEST_SKIP() << four << " is not here";
  const Rig rig = rig_of_observations(four);
  EXPECT_EQ(rig.cameras[0].name, "Basler_21275576");
  const auto frames = read_observations(four, rig);
  EXPECT_EQ(frames.size(), 464u);
  EXPECT_EQ(frames[0].of(CameraId{0})[0].pixel.x(), 92.678574);

  const Rig rig5 = rig_of_observations(five);
  const auto frames5 = read_observations(five, rig5);
  EXPECT_EQ(frames5.size(), 506u) << "cameras 1 and 4 saw all";
  std::size_t points = 0;
  for (const ObservedFrame& frame : frames5) points += frame.points.size();
  EXPECT_EQ(points, 506u + 414 + 456 + 506 + 240);
}

TEST(Observations, ReportsOutlierFrame) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.csv", "camera,frame,x,y\nleft,0,1,2\nleft,1,1,2\nleft,999999999,1,2\n");
  Rig rig;
  rig.cameras.emplace_back().name = "left";
  try {
    read_observations(folder / "a.csv", rig);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string_view(error.what()).find("frames 0 to 999999999 are named, of which 3 are there"), std::string_view::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace marey::format
