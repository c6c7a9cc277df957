#include "marey/source/video_source.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "marey/core/error.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::source {
namespace {

using test::ffmpeg;

struct Reading {
  SourceInfo info;
  std::vector<Frame> frames;
  std::vector<std::string> warnings;
};

Reading read_all(const std::string& path, std::optional<double> rate = std::nullopt) {
  const auto source = open_video(path, rate);
  Reading reading;
  reading.info = source->info();
  while (auto frame = source->next()) reading.frames.push_back(std::move(*frame));
  EXPECT_FALSE(source->next()) << "the end stays the end";
  reading.warnings = source->warnings();
  return reading;
}

/// A moving test image: `seconds` at `rate`, encoded as `encoding` says.
std::string video(const test::TemporaryFolder& folder, const std::string& name, const std::string& encoding, int seconds = 2,
                  int rate = 10) {
  const std::string path = folder / name;
  ffmpeg("-f lavfi -i testsrc2=size=64x48:rate=" + std::to_string(rate) + " -t " + std::to_string(seconds) + " " + encoding + " " +
         path);
  return path;
}

/// Means of blue, green and red.
cv::Scalar colour_of(const Frame& frame) {
  return cv::mean(frame.image.bgr());
}

TEST(VideoSource, ReadsEveryFrameInOrder) {
  const test::TemporaryFolder folder;
  const Reading reading = read_all(video(folder, "plain.avi", "-c:v mpeg4"));
  EXPECT_EQ(reading.info.size, cv::Size(64, 48));
  EXPECT_EQ(reading.info.rate_hz, 10.0);
  EXPECT_EQ(reading.info.frame_count, 20);
  ASSERT_EQ(reading.frames.size(), 20u);
  EXPECT_TRUE(reading.warnings.empty());
  for (std::size_t i = 0; i < reading.frames.size(); ++i) {
    EXPECT_EQ(reading.frames[i].index, static_cast<std::int64_t>(i));
    EXPECT_NEAR(seconds(reading.frames[i].time), 0.1 * static_cast<double>(i), 1e-6);
  }
}

TEST(VideoSource, FramesOutliveTheSource) {
  const test::TemporaryFolder folder;
  const std::string path = video(folder, "plain.mp4", "-c:v libx264 -pix_fmt yuv420p");
  const Reading reading = read_all(path);
  const cv::Scalar before = colour_of(reading.frames.front());
  EXPECT_GT(before[1], 10);
}

TEST(VideoSource, AGivenRateOverridesTheHeader) {
  const test::TemporaryFolder folder;
  const Reading reading = read_all(video(folder, "plain.avi", "-c:v mpeg4"), 4.0);
  EXPECT_EQ(reading.info.rate_hz, 4.0);
  EXPECT_EQ(reading.frames.at(8).time, timestamp_from_seconds(2.0));
}

TEST(VideoSource, TimesFollowAVariableRate) {
  const test::TemporaryFolder folder;
  const Reading reading =
      read_all(video(folder, "variable.mkv", "-vf \"select='not(eq(n,3)+eq(n,6)+eq(n,7))'\" -fps_mode vfr -c:v mpeg4"));
  ASSERT_EQ(reading.frames.size(), 17u);
  EXPECT_NEAR(seconds(reading.frames[2].time), 0.2, 2e-3);
  EXPECT_NEAR(seconds(reading.frames[3].time), 0.4, 2e-3);
  EXPECT_NEAR(seconds(reading.frames[5].time), 0.8, 2e-3);
  EXPECT_NEAR(seconds(reading.frames[16].time), 1.9, 2e-3);
  EXPECT_TRUE(reading.warnings.empty()) << reading.warnings.front();
}

TEST(VideoSource, FramesThatAreStoredOutOfOrderComeInOrder) {
  const test::TemporaryFolder folder;
  const Reading reading = read_all(video(folder, "b_frames.mp4", "-c:v libx264 -bf 3 -pix_fmt yuv420p"));
  ASSERT_EQ(reading.frames.size(), 20u);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_NEAR(seconds(reading.frames[i].time), 0.1 * static_cast<double>(i), 1e-6);
}

TEST(VideoSource, EveryWayToStoreAPictureGivesTheSameColours) {
  const test::TemporaryFolder folder;
  const cv::Scalar required = colour_of(read_all(video(folder, "reference.avi", "-c:v rawvideo -pix_fmt bgr24", 1)).frames.at(3));
  const std::vector<std::pair<std::string, std::string>> encodings = {
      {"limited.mkv", "-c:v ffv1 -pix_fmt yuv420p"},
      {"4_2_2.mkv", "-c:v ffv1 -pix_fmt yuv422p"},
      {"4_4_4.mkv", "-c:v ffv1 -pix_fmt yuv444p"},
      {"ten_bits.mkv", "-c:v ffv1 -pix_fmt yuv420p10le"},
      {"full_range.avi", "-c:v mjpeg -q:v 2 -pix_fmt yuvj420p"},
      {"full_range_4_2_2.avi", "-c:v mjpeg -q:v 2 -pix_fmt yuvj422p"},
      {"full_range_flag.mkv", "-vf scale=out_range=full -c:v ffv1 -pix_fmt yuv422p -color_range pc"},
      {"rgb.mkv", "-c:v ffv1 -pix_fmt bgr0"},
  };
  for (const auto& [name, encoding] : encodings) {
    const Reading reading = read_all(video(folder, name, encoding, 1));
    ASSERT_EQ(reading.frames.size(), 10u) << name;
    const cv::Scalar detected = colour_of(reading.frames[3]);
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(detected[channel], required[channel], 3) << name << ", channel " << channel;
  }
}

TEST(VideoSource, GreyStaysGreyAndDeepGreyStaysDeep) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(read_all(video(folder, "grey.mkv", "-c:v ffv1 -pix_fmt gray", 1)).frames.at(0).image.luma().type(), CV_8UC1);
  const Reading deep = read_all(video(folder, "deep.mkv", "-c:v ffv1 -pix_fmt gray16le", 1));
  EXPECT_EQ(deep.frames.at(0).image.luma().type(), CV_16UC1);
  EXPECT_FALSE(deep.frames.at(0).image.is_colour());
}

TEST(VideoSource, AFilmHeldUprightIsUpright) {
  const test::TemporaryFolder folder;
  const std::string plain = video(folder, "plain.mp4", "-c:v libx264 -pix_fmt yuv420p", 1);
  const std::string upright = folder / "upright.mp4";
  ffmpeg("-i " + plain + " -c copy -metadata:s:v rotate=90 " + upright);
  const Reading reading = read_all(upright);
  EXPECT_EQ(reading.info.size, cv::Size(48, 64));
  const std::string reference = folder / "reference.mkv";  // ffmpeg itself turns what it converts
  ffmpeg("-i " + upright + " -c:v ffv1 " + reference);
  const Reading required = read_all(reference);
  ASSERT_EQ(required.info.size, reading.info.size);
  EXPECT_EQ(cv::norm(required.frames.at(0).image.luma(), reading.frames.at(0).image.luma(), cv::NORM_INF), 0);
}

TEST(VideoSource, AFileThatBreaksOffIsReadAsFarAsItGoes) {
  const test::TemporaryFolder folder;
  for (const auto& [name, encoding] : std::vector<std::pair<std::string, std::string>>{
           {"cut.avi", "-c:v mpeg4"},
           {"cut.mp4", "-c:v libx264 -pix_fmt yuv420p -crf 10 -g 10 -movflags +faststart"},
           {"cut.mkv", "-c:v mpeg4"}}) {
    const std::string path = video(folder, name, encoding, 8);
    test::cut_file(path, 0.5);
    const Reading reading = read_all(path);
    EXPECT_GT(reading.frames.size(), 20u) << name;
    EXPECT_LT(reading.frames.size(), 60u) << name;
    ASSERT_FALSE(reading.warnings.empty()) << name;
    EXPECT_NE(reading.warnings.back().find("breaks off after " + std::to_string(reading.frames.size())), std::string::npos)
        << reading.warnings.back();
  }
}

TEST(VideoSource, AnMp4WithoutItsIndexIsRefused) {
  const test::TemporaryFolder folder;
  const std::string path = video(folder, "cut.mp4", "-c:v libx264 -pix_fmt yuv420p");
  test::cut_file(path, 0.5);
  EXPECT_THROW(open_video(path), Error);
}

TEST(VideoSource, APictureThatChangesSizeIsScaledToTheFirst) {
  const test::TemporaryFolder folder;
  const std::string small = folder / "small.h264", large = folder / "large.h264", both = folder / "both.h264";
  ffmpeg("-f lavfi -i testsrc2=size=64x48:rate=10 -t 1 -c:v libx264 -pix_fmt yuv420p " + small);
  ffmpeg("-f lavfi -i testsrc2=size=128x96:rate=10 -t 1 -c:v libx264 -pix_fmt yuv420p " + large);
  test::write_file(both, test::read_file(small) + test::read_file(large));
  const Reading reading = read_all(both);
  EXPECT_EQ(reading.frames.size(), 20u);
  for (const Frame& frame : reading.frames) EXPECT_EQ(frame.image.size(), cv::Size(64, 48));
  ASSERT_FALSE(reading.warnings.empty());
  EXPECT_NE(reading.warnings.front().find("size of the first: 10"), std::string::npos) << reading.warnings.front();
}

TEST(VideoSource, APictureOfOnePixel) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "dot.mkv";
  test::write_file(folder / "dot.raw", "\x10\x20\x30\x40\x50");
  ffmpeg("-f rawvideo -pixel_format gray -video_size 1x1 -framerate 5 -i " + (folder / "dot.raw") + " -c:v ffv1 -pix_fmt yuv420p " +
         path);
  const Reading reading = read_all(path);
  EXPECT_EQ(reading.frames.size(), 5u);
  EXPECT_EQ(reading.info.size, cv::Size(1, 1));
}

TEST(VideoSource, DamageInTheMiddleDoesNotEndTheFilm) {
  const test::TemporaryFolder folder;
  const std::string path = video(folder, "damaged.avi", "-c:v mpeg4 -g 5", 8);
  std::string bytes = test::read_file(path);
  for (std::size_t i = bytes.size() / 3; i < bytes.size() / 3 + 2000; ++i) bytes[i] = static_cast<char>(i * 131);
  test::write_file(path, bytes);
  const Reading reading = read_all(path);
  EXPECT_GT(reading.frames.size(), 60u);
}

TEST(VideoSource, RejectsNonVideo) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "text.avi", "This is a letter, not a video.\n");
  test::write_file(folder / "empty.mp4", "");
  for (const std::string name : {"text.avi", "empty.mp4", "missing.mp4", ""}) {
    try {
      open_video(folder / name);
      ADD_FAILURE() << name << " was opened";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
}

TEST(VideoSource, TheStreetVideo) {
  if (!std::filesystem::exists(test::vtest())) GTEST_SKIP() << test::vtest() << " is not here: install opencv-doc";
  const Reading reading = read_all(test::vtest(), 7);
  EXPECT_EQ(reading.frames.size(), 795u);
  ASSERT_EQ(reading.warnings.size(), 1u);
  EXPECT_NE(reading.warnings.front().find("its header says 10 frames per second, the given rate is 7"), std::string::npos)
      << reading.warnings.front();
}

}  // namespace
}  // namespace marey::source
