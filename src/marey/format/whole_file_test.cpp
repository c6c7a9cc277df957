#include "marey/format/whole_file.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "marey/core/error.h"

#include "support/files.h"

namespace marey::format {
namespace {

int entries(const test::TemporaryFolder& folder) {
  return static_cast<int>(std::distance(std::filesystem::directory_iterator(folder.path()), {}));
}

TEST(WholeFile, AppearsOnlyWhenItIsFinished) {
  const test::TemporaryFolder folder;
  WholeFile file(folder / "tracks.txt");
  file.write("one\n");
  file.write("two\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "tracks.txt"));
  file.finish();
  EXPECT_EQ(test::read_file(folder / "tracks.txt"), "one\ntwo\n");
  EXPECT_EQ(entries(folder), 1);
}

TEST(WholeFile, WithoutFinishTheOldOneStays) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "tracks.txt", "old");
  WholeFile(folder / "tracks.txt").write("new");
  EXPECT_EQ(test::read_file(folder / "tracks.txt"), "old");
  EXPECT_EQ(entries(folder), 1);
}

TEST(WholeFile, OfTwoWritersTheLastToFinishStaysWhole) {
  const test::TemporaryFolder folder;
  WholeFile one(folder / "tracks.txt");
  WholeFile other(folder / "tracks.txt");
  one.write("the one's text\n");
  other.write("the other's\n");
  one.finish();
  EXPECT_EQ(test::read_file(folder / "tracks.txt"), "the one's text\n");
  other.finish();
  EXPECT_EQ(test::read_file(folder / "tracks.txt"), "the other's\n");
  EXPECT_EQ(entries(folder), 1);
}

TEST(WholeFile, ALinkStaysALink) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "real.txt", "old");
  std::filesystem::create_symlink(folder / "real.txt", folder / "link.txt");
  WholeFile file(folder / "link.txt");
  file.write("new");
  file.finish();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(test::read_file(folder / "real.txt"), "new");
}

TEST(WholeFile, APlaceThatCannotBeWrittenIsSaid) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "file", "");
  EXPECT_THROW(WholeFile(folder / "file/tracks.txt"), Error);
  EXPECT_THROW(WholeFile(folder / "missing/tracks.txt"), Error);
  EXPECT_THROW(WholeFile(folder.path()), Error);
  EXPECT_EQ(test::read_file(folder / "file"), "");
}

TEST(WholeFile, AFullPlaceIsSaidAndADeviceIsNeverReplaced) {
  WholeFile file("/dev/full");
  file.write("text");
  EXPECT_THROW(file.finish(), Error);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

}  // namespace
}  // namespace marey::format
