#include "marey/format/whole_file.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "marey/core/error.h"

namespace marey {
namespace {

namespace fs = std::filesystem;

class WholeFileTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "marey-whole-file-XXXXXX";
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::size_t files() const { return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {})); }

  static std::string content(const std::string& path) {
    std::stringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }

  static std::string message_of(auto&& act) {
    try {
      act();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  fs::path folder_;
};

TEST_F(WholeFileTest, AppearsOnCommitAndLeavesNothingElse) {
  WholeFile file(path("a.txt"));
  file.write("one\n");
  file.write(std::string(1'000'000, 'x'));
  EXPECT_FALSE(fs::exists(path("a.txt")));
  file.commit();
  EXPECT_EQ(content(path("a.txt")), "one\n" + std::string(1'000'000, 'x'));
  EXPECT_EQ(files(), 1U);
}

TEST_F(WholeFileTest, WithoutCommitTheOldFileStays) {
  std::ofstream(path("a.txt")) << "old";
  {
    WholeFile file(path("a.txt"));
    file.write("new");
  }
  EXPECT_EQ(content(path("a.txt")), "old");
  EXPECT_EQ(files(), 1U);
}

TEST_F(WholeFileTest, KeepsModeAndFollowsLinks) {
  std::ofstream(path("real.txt")) << "old";
  fs::permissions(path("real.txt"), fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read);
  fs::create_symlink("real.txt", path("link.txt"));
  WholeFile file(path("link.txt"));
  file.write("new");
  file.commit();
  EXPECT_TRUE(fs::is_symlink(path("link.txt")));
  EXPECT_EQ(content(path("real.txt")), "new");
  EXPECT_EQ(fs::status(path("real.txt")).permissions(), fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read);
}

TEST_F(WholeFileTest, AnotherWriterMayFillThePart) {
  WholeFile file(path("film.mp4"));
  EXPECT_EQ(fs::path(file.part_path()).extension(), ".mp4");
  EXPECT_EQ(fs::path(file.part_path()).parent_path(), folder_);
  std::ofstream(file.part_path()) << "frames";
  file.commit();
  EXPECT_EQ(content(path("film.mp4")), "frames");
}

TEST_F(WholeFileTest, TwoAtOnceDoNotMeet) {
  WholeFile first(path("a.txt"));
  WholeFile second(path("a.txt"));
  first.write("first");
  second.write("second");
  second.commit();
  first.commit();
  EXPECT_EQ(content(path("a.txt")), "first");
}

TEST_F(WholeFileTest, MissingFolderIsToldAtOnce) {
  EXPECT_EQ(message_of([&] { WholeFile(path("no/such/a.txt")); }),
            path("no/such/a.txt") +
                ": cannot be written (No such file or directory); choose a folder that exists and that you may write to");
  EXPECT_EQ(message_of([&] { WholeFile(path("")); }), path("") + ": is a folder; give the name of a file to write");
  EXPECT_EQ(message_of([&] { WholeFile(""); }), "the output file has no name; give a path, or - for standard output");
}

TEST_F(WholeFileTest, FolderOfAnotherUserIsToldAtOnce) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(message_of([&] { WholeFile(path("a.txt")); }),
            path("a.txt") + ": cannot be written (Permission denied); choose a folder that exists and that you may write to");
  fs::permissions(folder_, fs::perms::owner_all);
}

TEST(WholeFile, FullDiskIsTold) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  WholeFile file("/dev/full");
  file.write("some text");
  try {
    file.commit();
    FAIL() << "the disk is full and nobody noticed";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "/dev/full: could not be written to the end (No space left on device); make room on the disk or choose another "
                 "place");
  }
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

}  // namespace
}  // namespace marey
