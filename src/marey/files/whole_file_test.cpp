#include "marey/files/whole_file.h"

#include <chrono>
#include <filesystem>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "marey/core/error.h"

#include "support/files.h"

namespace marey {
namespace {

int entries(const test::TemporaryFolder& folder) {
  return static_cast<int>(std::distance(std::filesystem::directory_iterator(folder.path()), {}));
}

/// Begins to write `path` in another process, which dies in the middle.
void write_and_die(const std::string& path) {
  const pid_t child = fork();
  if (child == 0) {
    WholeFile file(path);
    file.write("half a ");
    _exit(0);  // no destructor runs: as after a kill
  }
  int status = 0;
  waitpid(child, &status, 0);
}

TEST(WholeFile, AppearsOnlyWhenItIsFinished) {
  const test::TemporaryFolder folder;
  {
    WholeFile file(folder / "tracks.txt");
    file.write("one\n");
    file.write("two\n");
    EXPECT_FALSE(std::filesystem::exists(folder / "tracks.txt"));
    file.finish();
  }
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

TEST(WholeFile, OfTwoWritersTheSecondIsRefused) {
  const test::TemporaryFolder folder;
  WholeFile one(folder / "tracks.txt");
  one.write("the one's text\n");
  try {
    WholeFile other(folder / "tracks.txt");
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("tracks.txt: is being written by another run"), std::string::npos) << error.what();
  }
  one.finish();
  EXPECT_EQ(test::read_file(folder / "tracks.txt"), "the one's text\n");
  WholeFile next(folder / "tracks.txt");  // the lock went with the end
  next.write("the next one's\n");
  next.finish();
  EXPECT_EQ(test::read_file(folder / "tracks.txt"), "the next one's\n");
  EXPECT_EQ(entries(folder), 1);
}

TEST(WholeFile, ALinkAndItsFileAreOneOutput) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "real.txt", "old");
  std::filesystem::create_symlink(folder / "real.txt", folder / "link.txt");
  const WholeFile one(folder / "link.txt");
  EXPECT_THROW(WholeFile(folder / "real.txt"), Error);
}

TEST(WholeFile, NextWriterRemovesLeftoverFiles) {
  const test::TemporaryFolder folder;
  write_and_die(folder / "tracks.txt");
  ASSERT_EQ(entries(folder), 2);  // its temporary file and its lock file, which no process holds
  WholeFile other(folder / "tracks.txt.old");
  other.write("a name that begins alike");
  other.finish();
  ASSERT_EQ(entries(folder), 3);
  WholeFile file(folder / "tracks.txt");
  file.write("whole");
  file.finish();
  EXPECT_EQ(test::read_file(folder / "tracks.txt"), "whole");
  EXPECT_EQ(entries(folder), 2);
}

TEST(WholeFile, OtherHostsTemporaryFilesGoWhenTheyAreOlderThanADay) {
  const test::TemporaryFolder folder;
  const std::string fresh = folder / "tracks.txt.far.away-7-0123456789abcdef.part";
  const std::string old = folder / "tracks.txt.far.away-7-fedcba9876543210.part";
  const std::string foreign = folder / "tracks.txt.mine.part";  // not made by a WholeFile
  for (const std::string& path : {fresh, old, foreign}) test::write_file(path, "x");
  const auto long_ago = std::filesystem::file_time_type::clock::now() - std::chrono::hours(25);
  std::filesystem::last_write_time(old, long_ago);
  std::filesystem::last_write_time(foreign, long_ago);
  WholeFile(folder / "tracks.txt").finish();
  EXPECT_TRUE(std::filesystem::exists(fresh));
  EXPECT_FALSE(std::filesystem::exists(old));
  EXPECT_TRUE(std::filesystem::exists(foreign));
}

TEST(UnfinishedFile, TemporaryNamesNeverCollide) {
  const test::TemporaryFolder folder;
  std::string first;
  {
    first = UnfinishedFile(folder / "film.mp4").temporary_path();
  }
  const UnfinishedFile second(folder / "film.mp4");
  EXPECT_NE(first, second.temporary_path());
  EXPECT_TRUE(first.starts_with(folder / "film.mp4."));
  EXPECT_TRUE(first.ends_with(".part"));
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
}  // namespace marey
