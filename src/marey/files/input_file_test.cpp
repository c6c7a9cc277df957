#include "marey/files/input_file.h"

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "marey/core/error.h"

#include "support/files.h"

namespace marey {
namespace {

using std::chrono::milliseconds;

std::string all_of(InputFile& file) {
  std::string text;
  std::vector<char> piece(7);
  while (const std::size_t got = file.read(piece)) text.append(piece.data(), got);
  return text;
}

struct Pipe {
  explicit Pipe(const test::TemporaryFolder& folder) : path(folder / "pipe") { EXPECT_EQ(mkfifo(path.c_str(), 0600), 0); }
  std::string path;
};

TEST(InputFile, ReadsAFileToItsEnd) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.txt", "what is written here is read");
  InputFile file(folder / "a.txt");
  EXPECT_EQ(all_of(file), "what is written here is read");
}

TEST(InputFile, NamesMissingFile) {
  try {
    InputFile("nowhere/at_all.txt");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("nowhere/at_all.txt: cannot be read"), std::string::npos);
  }
}

TEST(InputFile, WaitsForAPipesWriterAndReadsUntilItGoes) {
  const test::TemporaryFolder folder;
  const Pipe pipe(folder);
  InputFile file(pipe.path);
  std::thread writer([&] {
    std::this_thread::sleep_for(milliseconds(150));
    const int to = open(pipe.path.c_str(), O_WRONLY);
    EXPECT_EQ(write(to, "first ", 6), 6);
    std::this_thread::sleep_for(milliseconds(150));
    EXPECT_EQ(write(to, "second", 6), 6);
    close(to);
  });
  EXPECT_EQ(all_of(file), "first second");
  writer.join();
}

TEST(InputFile, ASilentPipeIsLeftWhenTheReaderIsAskedToStop) {
  const test::TemporaryFolder folder;
  const Pipe pipe(folder);
  for (const bool has_writer : {false, true}) {
    const int writer = has_writer ? open(pipe.path.c_str(), O_RDWR) : -1;
    std::stop_source source;
    std::thread stopper([&] {
      std::this_thread::sleep_for(milliseconds(200));
      source.request_stop();
    });
    InputFile file(pipe.path, source.get_token());
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_THROW(all_of(file), Stopped);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, milliseconds(1000));
    stopper.join();
    if (has_writer) close(writer);
  }
}

TEST(InputStream, ReadsLinesAndFailsAsAFileStreamDoes) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.txt", "one\ntwo\n" + std::string(100'000, 'x'));
  InputStream in(folder / "a.txt");
  std::string line;
  ASSERT_TRUE(std::getline(in, line));
  EXPECT_EQ(line, "one");
  ASSERT_TRUE(std::getline(in, line));
  ASSERT_TRUE(std::getline(in, line));
  EXPECT_EQ(line.size(), 100'000u);
  EXPECT_FALSE(std::getline(in, line));
  InputStream missing(folder / "b.txt");
  EXPECT_FALSE(missing);
}

TEST(InputStream, AStopComesThrough) {
  const test::TemporaryFolder folder;
  const Pipe pipe(folder);
  std::stop_source source;
  source.request_stop();
  const StopScope scope(source.get_token());
  InputStream in(pipe.path);
  std::string line;
  EXPECT_THROW(std::getline(in, line), Stopped);
}

}  // namespace
}  // namespace marey
