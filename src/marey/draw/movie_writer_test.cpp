#include "marey/draw/movie_writer.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/draw/canvas.h"

#include "support/files.h"

namespace marey::draw {
namespace {

Picture shade(cv::Size size, int level) {
  return Canvas(Picture::from_bgr(cv::Mat(size, CV_8UC3, cv::Scalar::all(level)))).take();
}

/// What ffprobe says of the film's frames: "time,time,…", and of its stream.
std::string probe(const test::TemporaryFolder& folder, const std::string& path, const std::string& what) {
  const std::string answer = folder / "probe.txt";
  const std::string command =
      "ffprobe -v error -select_streams v -show_entries " + what + " -of csv=p=0 " + path + " | sort > " + answer;
  EXPECT_EQ(std::system(command.c_str()), 0);
  return test::read_file(answer);
}

TEST(MovieWriter, WritesAFilmThatBrowsersPlay) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "film.mp4";
  MovieWriter writer(path, {65, 49}, 10);
  for (const double time : {0.0, 0.1, 0.2, 0.5, 0.6}) writer.write(shade({65, 49}, 100), timestamp_from_seconds(time));
  EXPECT_FALSE(std::filesystem::exists(path)) << "not before it is whole";
  writer.finish();
  EXPECT_EQ(probe(folder, path, "stream=codec_name,width,height,pix_fmt"), "h264,66,50,yuv420p\n");
  EXPECT_EQ(probe(folder, path, "packet=pts_time").substr(0, 40), "0.000000\n0.100000\n0.200000\n0.500000\n0.60");
  const std::string bytes = test::read_file(path);
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat")) << "the index comes first";
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2)
      << "the film and the probe's answer, nothing else";
}

TEST(MovieWriter, ShadesComeBack) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "film.mp4";
  MovieWriter writer(path, {64, 48}, 5);
  for (int i = 0; i < 5; ++i) writer.write(shade({64, 48}, 200), timestamp_from_seconds(0.2 * i));
  writer.finish();
  test::ffmpeg("-i " + path + " -frames:v 1 -pix_fmt gray -f rawvideo " + (folder / "raw"));
  const std::string raw = test::read_file(folder / "raw");
  ASSERT_EQ(raw.size(), 64u * 48u);
  EXPECT_NEAR(static_cast<unsigned char>(raw[1000]), 200, 3);
}

TEST(MovieWriter, LeavesNothingBehindUnlessFinished) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "film.mp4", "the old one");
  {
    MovieWriter writer(folder / "film.mp4", {64, 48}, 10);
    writer.write(shade({64, 48}, 10), Timestamp{});
  }
  EXPECT_EQ(test::read_file(folder / "film.mp4"), "the old one");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(MovieWriter, APlaceThatCannotBeWrittenIsRefused) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "file", "");
  EXPECT_THROW(MovieWriter(folder / "file/film.mp4", {64, 48}, 10), Error);
  EXPECT_THROW(MovieWriter(folder / "missing/film.mp4", {64, 48}, 10), Error);
  EXPECT_THROW(MovieWriter("/dev/full", {64, 48}, 10), Error);
  EXPECT_THROW(MovieWriter(folder.path(), {64, 48}, 10), Error);
}

}  // namespace
}  // namespace marey::draw
