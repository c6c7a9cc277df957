#include "marey/draw/movie_writer.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/draw/canvas.h"

#include "support/files.h"

namespace marey::draw {
namespace {

Image shade(cv::Size size, int level) {
  return Canvas(Image::from_bgr(cv::Mat(size, CV_8UC3, cv::Scalar::all(level)))).take();
}

/// What ffprobe says of the video's frames: "time,time,…", and of its stream.
std::string probe(const test::TemporaryFolder& folder, const std::string& path, const std::string& what) {
  const std::string answer = folder / "probe.txt";
  const std::string command =
      "ffprobe -v error -select_streams v -show_entries " + what + " -of csv=p=0 " + path + " | sort > " + answer;
  EXPECT_EQ(std::system(command.c_str()), 0);
  return test::read_file(answer);
}

std::ptrdiff_t lines_of(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
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
      << "the video and the probe's answer, nothing else";
}

TEST(MovieWriter, ASoundGoesAlongUnchanged) {
  const test::TemporaryFolder folder;
  const std::string source = folder / "source.mp4", video = folder / "film.mp4";
  test::ffmpeg("-f lavfi -i color=gray:size=64x48:rate=10:duration=3 -f lavfi -i sine=frequency=440:duration=5 -c:a aac " + source);
  MovieWriter writer(video, {64, 48}, 10, MovieWriter::Quality::to_view, MovieWriter::Keep::when_finished, source);
  for (int i = 0; i < 30; ++i) writer.write(shade({64, 48}, 100), timestamp_from_seconds(0.1 * i));
  writer.finish();
  const auto sound = [&](const std::string& path) {
    test::ffmpeg("-i " + path + " -vn -t 2.5 -ac 1 -f s16le " + (folder / "sound.raw"));
    return test::read_file(folder / "sound.raw");
  };
  const std::string received = sound(video), there = sound(source);
  EXPECT_NEAR(static_cast<double>(received.size()), static_cast<double>(there.size()), 9000) << "of 220,500 bytes";
  EXPECT_EQ(lines_of(probe(folder, video, "packet=pts_time")), 30) << "every image is there";
  const std::string length = folder / "length.txt";
  EXPECT_EQ(std::system(("ffprobe -v error -show_entries format=duration -of csv=p=0 " + video + " > " + length).c_str()), 0);
  EXPECT_NEAR(std::stod(test::read_file(length)), 3.0, 0.15) << "no longer than the images";
  const std::string bytes = test::read_file(video);
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat")) << "the index comes first";
  // A video without sound gives none, and nothing that is not a video harms.
  for (const std::string& silent : {video + "x", folder / "sound.raw"}) {
    MovieWriter mute(folder / "mute.mp4", {64, 48}, 10, MovieWriter::Quality::to_view, MovieWriter::Keep::when_finished, silent);
    mute.write(shade({64, 48}, 100), Timestamp{});
    mute.finish();
    EXPECT_EQ(lines_of(probe(folder, folder / "mute.mp4", "packet=pts_time")), 1);
  }
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

/// The times of the frames that a player shows of a file that was copied as a kill would leave it, its first `bytes` alone.
std::string times_of_torn(const test::TemporaryFolder& folder, const std::string& path, std::size_t bytes) {
  const std::string torn = folder / "torn.mp4", times = folder / "times.txt";
  test::write_file(torn, test::read_file(path).substr(0, bytes));
  const std::string command = "ffprobe -v quiet -select_streams v -show_entries frame=pts_time -of default=nk=1:nw=1 " + torn +
                              " | "
                              "grep [0-9] > " +
                              times;
  EXPECT_EQ(std::system(command.c_str()), 0) << bytes;
  return test::read_file(times);
}

TEST(MovieWriter, FramesWrittenBeforeAKillCanBeRead) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "film.mp4";
  MovieWriter writer(path, {64, 48}, 20, MovieWriter::Quality::to_record, MovieWriter::Keep::always);
  for (int i = 0; i < 60; ++i) writer.write(shade({64, 48}, 4 * i), timestamp_from_seconds(0.05 * i));
  const std::size_t size = std::filesystem::file_size(path);
  const std::string times = times_of_torn(folder, path, size);
  EXPECT_GE(lines_of(times), 50) << "half a second is the most that is lost";
  EXPECT_EQ(times.substr(0, 27), "0.000000\n0.050000\n0.100000\n");
  std::ptrdiff_t before = 0;
  for (const double fraction : {0.5, 0.7, 0.9}) {
    const std::ptrdiff_t lines =
        lines_of(times_of_torn(folder, path, static_cast<std::size_t>(fraction * static_cast<double>(size))));
    EXPECT_GE(lines, before + 5) << fraction;
    before = lines;
  }
}

TEST(MovieWriter, AFilmThatIsAlwaysKeptEndsAsAnyOther) {
  const test::TemporaryFolder folder;
  for (const auto keep : {MovieWriter::Keep::when_finished, MovieWriter::Keep::always}) {
    MovieWriter writer(folder / (keep == MovieWriter::Keep::always ? "kept.mp4" : "film.mp4"), {64, 48}, 20,
                       MovieWriter::Quality::to_view, keep);
    for (int i = 0; i < 60; ++i) writer.write(shade({64, 48}, 4 * i), timestamp_from_seconds(0.05 * i));
    writer.finish();
  }
  EXPECT_EQ(test::read_file(folder / "kept.mp4"), test::read_file(folder / "film.mp4"));
  const std::string bytes = test::read_file(folder / "kept.mp4");
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat")) << "the index comes first";
  EXPECT_EQ(bytes.find("moof"), std::string::npos);
  EXPECT_EQ(probe(folder, folder / "kept.mp4", "stream=nb_frames,duration"), "3.000000,60\n");
  EXPECT_EQ(lines_of(times_of_torn(folder, folder / "kept.mp4", bytes.size())), 60);
}

TEST(MovieWriter, KeepsFileWithoutFinish) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "film.mp4";
  test::write_file(path, "the old one");
  {
    MovieWriter writer(path, {64, 48}, 10, MovieWriter::Quality::to_record, MovieWriter::Keep::always);
    for (int i = 0; i < 20; ++i) writer.write(shade({64, 48}, 10 * i), timestamp_from_seconds(0.1 * i));
    EXPECT_THROW(MovieWriter(path, {64, 48}, 10), Error) << "another run cannot write it in the meantime";
  }
  EXPECT_GE(lines_of(times_of_torn(folder, path, std::filesystem::file_size(path))), 15);
}

TEST(MovieWriter, FramesOfAFilmBesideItsNameCanBeReadToo) {
  const test::TemporaryFolder folder;
  MovieWriter writer(folder / "film.mp4", {64, 48}, 20);
  for (int i = 0; i < 60; ++i) writer.write(shade({64, 48}, 4 * i), timestamp_from_seconds(0.05 * i));
  std::string part;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    if (entry.path().extension() == ".part") part = entry.path();
  ASSERT_FALSE(part.empty());
  EXPECT_GE(lines_of(times_of_torn(folder, part, std::filesystem::file_size(part))), 40);
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
