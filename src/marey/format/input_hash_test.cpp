#include "marey/format/input_hash.h"

#include <set>

#include <gtest/gtest.h>

#include "support/files.h"

namespace marey::format {
namespace {

TEST(InputHash, IsOfSizeBeginningAndEnd) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "film.mp4";
  std::set<std::string> hashes;
  const auto hash_of = [&](const std::string& text) {
    test::write_file(path, text);
    EXPECT_EQ(input_of(path).name, "film.mp4");
    return input_of(path).hash;
  };
  const std::string large(3 << 20, 'x');
  for (const std::size_t location : {std::size_t{0}, std::size_t{1} << 19, large.size() - 1}) {
    std::string other = large;
    other[location] = 'y';
    EXPECT_TRUE(hashes.insert(hash_of(other)).second) << location;
  }
  EXPECT_TRUE(hashes.insert(hash_of(large)).second);
  EXPECT_TRUE(hashes.insert(hash_of(large + "x")).second);
  EXPECT_TRUE(hashes.insert(hash_of("x")).second);
  EXPECT_TRUE(hashes.insert(hash_of("")).second);
  std::string middle = large;
  middle[large.size() / 2] = 'y';
  EXPECT_FALSE(hashes.insert(hash_of(middle)).second) << "what lies between is not read";
}

TEST(InputHash, IsFnv1a) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a", "");
  // FNV-1a of eight bytes of 0.
  std::uint64_t hash = 0xcbf29ce484222325;
  for (int i = 0; i < 8; ++i) hash *= 0x100000001b3;
  EXPECT_EQ(std::stoull(input_of(folder / "a").hash, nullptr, 16), hash);
}

TEST(InputHash, FoldersAndWhatIsNotThereHaveNone) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(input_of(folder.path()).hash, "");
  EXPECT_EQ(input_of(folder / "none"), (MadeBy::Input{"none", ""}));
}

}  // namespace
}  // namespace marey::format
