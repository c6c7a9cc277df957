#include "marey/draw/svg.h"

#include <array>

#include <gtest/gtest.h>

namespace marey::draw {
namespace {

TEST(Svg, WritesNumbersAsShortAsItsDecimalsAllow) {
  Svg svg({{"width", 100}}, 2);
  svg.rect({-0.126, 2.5, 30, 1e6}, {{"rx", 0}});
  const std::array<Vector<2>, 2> points{Vector<2>(1, 2.25), Vector<2>(0.333, 100)};
  svg.polyline(points, {{"stroke", "red"}});
  EXPECT_EQ(svg.str(), R"(<svg xmlns="http://www.w3.org/2000/svg" width="100">
<rect x="-0.13" y="2.5" width="30" height="1000000" rx="0" />
<polyline fill="none" points="1,2.25 0.33,100 " stroke="red" />
</svg>
)");
}

TEST(Svg, IsWellFormedWhateverItsTextsAre) {
  Svg svg({});
  const std::string hostile = "</text><script>\" ' & ]]> \xFF \x01 \xEF\xBF\xBF";
  svg.text({0, 0}, hostile).add("title", {{"id", hostile}}, hostile);
  pugi::xml_document read;
  ASSERT_TRUE(read.load_string(svg.str().c_str()));
  const pugi::xml_node text = read.child("svg").child("text");
  const std::string plain = "</text><script>\" ' & ]]> \xEF\xBF\xBD \xEF\xBF\xBD \xEF\xBF\xBD";
  EXPECT_EQ(text.child_value(), plain);
  EXPECT_EQ(text.child_value("title"), plain);
  EXPECT_EQ(text.child("title").attribute("id").value(), plain);
}

TEST(Svg, StepsAreRound) {
  EXPECT_DOUBLE_EQ(round_step(1), 1);
  EXPECT_DOUBLE_EQ(round_step(0.013), 0.02);
  EXPECT_DOUBLE_EQ(round_step(230), 500);
  EXPECT_DOUBLE_EQ(round_step(51), 100);
}

}  // namespace
}  // namespace marey::draw
