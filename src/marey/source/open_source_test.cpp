#include "marey/source/open_source.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/source/image_sequence.h"

#include "support/files.h"

namespace marey::source {
namespace {

/// Five images, shot_8.png to shot_12.png, each one grey level.
void shoot(const test::TemporaryFolder& folder) {
  for (int i = 8; i <= 12; ++i) {
    test::ffmpeg("-f lavfi -i color=gray:size=32x24 -frames:v 1 " + (folder / ("shot_" + std::to_string(i) + ".png")));
  }
}

std::size_t count(Source& source) {
  std::size_t frames = 0;
  while (source.next()) ++frames;
  return frames;
}

TEST(OpenSource, APictureFolderIsSortedAsAPersonWould) {
  const test::TemporaryFolder folder;
  for (const char* name : {"b.png", "a10.png", "a9.PNG", "a010x.png", "notes.txt", ".hidden.png", "a2.jpg"})
    test::write_file(folder / name, "x");
  std::vector<std::string> names;
  for (const std::string& path : find_images(folder.path())) names.push_back(std::filesystem::path(path).filename());
  EXPECT_EQ(names, (std::vector<std::string>{"a2.jpg", "a9.PNG", "a10.png", "a010x.png", "b.png"}));
}

TEST(OpenSource, FoldersAndPatternsNameTheSamePictures) {
  const test::TemporaryFolder folder;
  shoot(folder);
  for (const std::string name : {"", "shot_%d.png", "shot_%04d.png", "shot_*.png", "*.png"}) {
    const auto source = open_source(folder / name, 5.0);
    EXPECT_EQ(source->info().frame_count, 5) << name;
    EXPECT_EQ(source->info().size, cv::Size(32, 24));
    EXPECT_EQ(count(*source), 5u) << name;
    EXPECT_TRUE(source->warnings().empty());
  }
  EXPECT_EQ(find_images(folder / "shot_?.png").size(), 2u);
  EXPECT_EQ(count(*open_source(folder / "shot_10.png")), 1u);
}

TEST(OpenSource, PicturesThatLieInAFolderByChanceAreNoSequence) {
  const test::TemporaryFolder folder;
  shoot(folder);
  test::ffmpeg("-f lavfi -i color=gray:size=16x12 -frames:v 1 " + (folder / "thumbnail.png"));
  std::string stated;
  try {
    open_source(folder.path());
  } catch (const Error& error) {
    stated = error.what();
  }
  EXPECT_NE(stated.find("its 6 images are not sequence"), std::string::npos) << stated;
  EXPECT_NE(stated.find("there are shot_8.png and thumbnail.png"), std::string::npos) << stated;
  EXPECT_EQ(open_source(folder / "shot_%d.png", 5.0)->info().frame_count, 5);
  EXPECT_EQ(open_source(folder / "*.png", 5.0)->info().frame_count, 6) << "who names them all gets them all";
}

TEST(OpenSource, FoldersOfTargaAndOfDeepTiffAreRead) {
  const test::TemporaryFolder folder;
  for (const char* name : {"a/1.tga", "a/2.TGA"}) {
    std::filesystem::create_directories(folder / "a");
    test::ffmpeg("-f lavfi -i color=gray:size=32x24 -frames:v 1 -c:v targa -f image2 " + (folder / name));
  }
  EXPECT_EQ(count(*open_source(folder / "a")), 2u);
  std::filesystem::create_directories(folder / "b");
  test::ffmpeg("-f lavfi -i color=gray:size=32x24 -frames:v 1 -pix_fmt gray16le " + (folder / "b/1.tiff"));
  const auto deep = open_source(folder / "b");
  const auto frame = deep->next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->image.luma().depth(), CV_16U);
}

TEST(OpenSource, PicturesWithoutARateSayWhatWasAssumed) {
  const test::TemporaryFolder folder;
  shoot(folder);
  const auto source = open_source(folder.path());
  EXPECT_EQ(source->info().rate_hz, 25.0);
  ASSERT_EQ(source->warnings().size(), 1u);
  EXPECT_NE(source->warnings()[0].find("--rate"), std::string::npos);
}

TEST(OpenSource, APictureThatCannotBeUsedIsLeftOutAndItsTimePasses) {
  const test::TemporaryFolder folder;
  shoot(folder);
  test::write_file(folder / "shot_9.png", "not an image");
  test::ffmpeg("-f lavfi -i color=gray:size=16x16 -frames:v 1 " + (folder / "shot_10.png"));
  const auto source = open_source(folder.path(), 10.0);
  std::vector<double> times;
  while (auto frame = source->next()) times.push_back(seconds(frame->time));
  EXPECT_EQ(times, (std::vector<double>{0.0, 0.3, 0.4}));
  ASSERT_EQ(source->warnings().size(), 1u);
  EXPECT_NE(source->warnings()[0].find("2 of 5 images omitted; the first: shot_9.png cannot be read"), std::string::npos);
}

TEST(OpenSource, DeepPicturesStayDeep) {
  const test::TemporaryFolder folder;
  test::ffmpeg("-f lavfi -i color=white:size=32x24 -frames:v 1 -pix_fmt gray16be " + (folder / "deep.png"));
  const auto frame = open_source(folder / "deep.png", 1.0)->next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->image.luma().type(), CV_16UC1);
  EXPECT_GT(cv::mean(frame->image.luma())[0], 60000);
}

TEST(OpenSource, NothingToReadIsSaidInOneSentence) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "nothing");
  std::filesystem::create_directory(folder / "bad");
  test::write_file(folder / "bad/picture.png", "not an image");
  for (const std::string name : {"nothing", "bad", "missing", "missing/shot_%d.png", "*.jpg"}) {
    EXPECT_THROW(open_source(folder / name), Error) << name;
  }
}

}  // namespace
}  // namespace marey::source
