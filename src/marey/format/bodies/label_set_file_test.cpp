#include "marey/format/bodies/label_set_file.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"

#include "support/files.h"

namespace marey::format::bodies {
namespace {

LearnedMarkers four() {
  LearnedMarkers set;
  set.labels = {"a", "b \"two\"", "c", "d"};
  set.locations = {{0, 0, 0}, {0.125, 0, 0}, {0, 0.25, 0}, {0, 0, 1.5}};
  for (int i = 0; i < 6; ++i) set.distances.push_back({0.25 * i, 0.125});
  set.moves = false;
  set.scaled = true;
  return set;
}

TEST(LabelSetFile, ComesBackAsItWasWritten) {
  const test::TemporaryFolder folder;
  write_label_set(folder / "set.toml", four());
  EXPECT_EQ(read_label_set(folder / "set.toml"), four());
}

TEST(LabelSetFile, SaysWhatIsWrong) {
  const auto refusal = [](std::string text) {
    try {
      parse_label_set(text, "s.toml");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(refusal("labels = [\"a\"]").find("4 to"), std::string::npos);
  EXPECT_NE(refusal("labels = [\"a\", \"b\", \"c\", \"c\"]").find("twice"), std::string::npos);
  std::string cut = label_set_text(four());
  cut.replace(cut.find("1.50000"), 7, "inf");
  EXPECT_NE(refusal(cut).find("places"), std::string::npos);
  EXPECT_NE(refusal("labels = [[[").find("s.toml:1"), std::string::npos);
}

}  // namespace
}  // namespace marey::format::bodies
