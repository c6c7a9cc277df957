#include "marey/format/bodies/body_file.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"

#include "support/files.h"

namespace marey::format::bodies {
namespace {

std::string refusal(const std::string& text) {
  try {
    parse_bodies(text, "b.toml");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(BodyFile, ComesBackAsItWasWritten) {
  Body racket;
  racket.id = BodyId{1};
  racket.label = "racket \"one\"";
  racket.markers = {{"tip", {0, 0.125, 0.3125}}, {"left", {-0.1, 0, 0}}, {"right", {0.1, 0, 0.0000001}}};
  Body cap = racket;
  cap.id = BodyId{2};
  cap.label = "cap";
  const test::TemporaryFolder folder;
  write_bodies(folder / "b.toml", {racket, cap}, {{"turned 180° about its z axis it appears the same"}, {}});
  EXPECT_EQ(read_bodies(folder / "b.toml"), (std::vector<Body>{racket, cap}));
  EXPECT_EQ(test::read_file(folder / "b.toml").substr(0, 8), "# turned");
}

TEST(BodyFile, ATableOfPlacesIsABody) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "cap.csv", "label,x,y,z\na,0,0,0\nb,0.1,0,0\nc,0,0.2,0\n");
  const std::vector<Body> bodies = read_bodies(folder / "cap.csv");
  ASSERT_EQ(bodies.size(), 1U);
  EXPECT_EQ(bodies[0].label, "cap");
  EXPECT_EQ(bodies[0].markers[2], (BodyMarker{"c", {0, 0.2, 0}}));
}

TEST(BodyFile, SaysEverythingThatIsWrong) {
  EXPECT_NE(refusal("").find("there is no body"), std::string::npos);
  EXPECT_NE(refusal("[[body]]\nname = \"a\"\n").find("b.toml:1: "), std::string::npos);
  const std::string many = refusal(
      "[[body]]\nname = \"a\"\ncolour = 3\n"
      "[[body.marker]]\nlabel = \"p\"\nposition = [0, 0]\n"
      "[[body.marker]]\nlabel = \"p\"\nposition = [0, 0, 1]\n"
      "[[body.marker]]\nposition = [0, 1, 1]\n");
  for (const char* part : {"b.toml:3: ", "b.toml:6: ", "twice", "has no label"})
    EXPECT_NE(many.find(part), std::string::npos) << many;
}

}  // namespace
}  // namespace marey::format::bodies
