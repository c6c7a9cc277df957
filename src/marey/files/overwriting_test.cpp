#include "marey/files/overwriting.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "support/files.h"

namespace marey {
namespace {

TEST(Overwriting, AFileIsKnownThroughLinks) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "a.csv", hard = folder / "hard.csv", soft = folder / "soft.csv", other = folder / "b.csv";
  test::write_file(file, "1");
  test::write_file(other, "1");
  std::filesystem::create_hard_link(file, hard);
  std::filesystem::create_symlink(file, soft);
  for (const std::string& output : {file, hard, soft, folder / "./a.csv"}) EXPECT_TRUE(overwrites(output, file)) << output;
  EXPECT_FALSE(overwrites(other, file));
  EXPECT_FALSE(overwrites(folder / "not there", file));
  EXPECT_FALSE(overwrites(file, ""));
  EXPECT_FALSE(overwrites("/dev/null", "/dev/null"));
  EXPECT_FALSE(overwrites("-", "-"));
  EXPECT_TRUE(is_one_file(folder / "new", folder / "./new"));
  EXPECT_FALSE(is_one_file(folder / "new", file));
}

TEST(Overwriting, AFolderAndAPatternStandForTheirPictures) {
  const test::TemporaryFolder folder;
  const std::string image = folder / "001.png", text = folder / "001.txt";
  test::write_file(image, "1");
  test::write_file(text, "1");
  EXPECT_TRUE(overwrites(image, folder.path()));
  EXPECT_TRUE(overwrites(image, folder / "%03d.png"));
  EXPECT_FALSE(overwrites(image, folder / "*.jpg"));
  EXPECT_FALSE(overwrites(text, folder.path()));
}

}  // namespace
}  // namespace marey
