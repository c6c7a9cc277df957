#include "marey/format/motion/marker_set.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"

#include "support/files.h"

namespace marey::format::motion {
namespace {

TEST(MarkerSet, NamesAloneOrWithPlaces) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "names.txt", "# a hand\nthumb\n\n little finger \n");
  const MarkerSet names = read_marker_set(folder / "names.txt");
  EXPECT_EQ(names.labels, (std::vector<std::string>{"thumb", "little finger"}));
  EXPECT_FALSE(names.has_positions());
  test::write_file(folder / "set.csv", "label,x,y,z\r\nhead, 0, 0.1 ,1.8\r\nfoot,1,2,-3e-1\r\n");
  const MarkerSet set = read_marker_set(folder / "set.csv");
  ASSERT_EQ(set.locations.size(), 2);
  EXPECT_EQ(set.labels[1], "foot");
  EXPECT_EQ(set.locations[1], Vector<3>(1, 2, -0.3));
}

TEST(MarkerSet, RefusesWhatIsNeither) {
  const test::TemporaryFolder folder;
  const auto refuses = [&](const char* text, const char* part) {
    test::write_file(folder / "set.csv", text);
    try {
      read_marker_set(folder / "set.csv");
      ADD_FAILURE() << text << " was taken";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  refuses("", "no name");
  refuses("a\nb\na\n", ":3:");
  refuses("label,x,y,z\nhead,1,2\n", "3 values");
  refuses("label,x,y,z\nhead,1,2,nan\n", "nan");
  refuses("label,x,y,z\n,1,2,3\n", "without a name");
  EXPECT_THROW(read_marker_set(folder / "missing.csv"), Error);
}

}  // namespace
}  // namespace marey::format::motion
