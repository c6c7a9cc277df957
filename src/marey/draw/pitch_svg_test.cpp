#include "marey/draw/pitch_svg.h"

#include <gtest/gtest.h>

#include "marey/draw/pitch_drawing.h"

namespace marey::draw {
namespace {

TEST(PitchSvg, HasTheSameCornerOnTheLeftAboveAsOtherViews) {
  for (const bool y_down : {true, false}) {
    const PitchFrame frame{.size = {100, 60}, .corner = {-50, 10}, .y_down = y_down};
    const std::string html = PitchSvg(frame).html();
    EXPECT_NE(html.find(y_down ? R"(viewBox="-53.00 7.00 106.00 66.00")" : R"(viewBox="-53.00 -73.00 106.00 66.00")"),
              std::string::npos)
        << html;
    EXPECT_NE(html.find(y_down ? R"--(transform="scale(1 1)")--" : R"--(transform="scale(1 -1)")--"), std::string::npos) << html;
  }
}

int channel(const std::string& css, int which) {
  return std::stoi(css.substr(1 + 2 * static_cast<std::size_t>(which), 2), nullptr, 16);
}

TEST(PitchSvg, ShirtsCanBeSeenOnTheGrass) {
  const std::string white = colour_on_grass(Appearance{.lightness = 80}), grey = colour_on_grass(Appearance{.lightness = 46});
  EXPECT_GT(channel(white, 0), 240) << "video shows white shirts as grey: " << white;
  EXPECT_GT(channel(grey, 1), 130) << "as bright as it must be: " << grey;
  EXPECT_LT(channel(grey, 1), channel(white, 1) - 40) << "and not white";
  EXPECT_LT(channel(colour_on_grass(Appearance{.lightness = 18}), 1), 10) << "black stays so";
  const std::string red = colour_on_grass(Appearance{.lightness = 42, .a = 48, .b = 28});
  EXPECT_GT(channel(red, 0), 230) << red;
  EXPECT_GT(channel(red, 0), channel(red, 1) + 100) << "red stays red: " << red;
  const std::string green = colour_on_grass(Appearance{.lightness = 50, .a = -40, .b = 30});
  EXPECT_GT(channel(green, 1), 130) << "and green is brighter than the grass: " << green;
}

TEST(PitchSvg, AMapHasItsOriginWhereThePitchHas) {
  const auto everywhere = [](const Vector<2>&) { return std::optional(0.01); };
  const std::string down = pitch_map_svg("map", {100, 60}, true, everywhere),
                    up = pitch_map_svg("map", {100, 60}, false, everywhere);
  EXPECT_NE(down.find("translate(24,40) scale(8 8)"), std::string::npos) << down.substr(0, 800);
  EXPECT_NE(up.find("translate(24,520) scale(8 -8)"), std::string::npos) << up.substr(0, 800);
}

}  // namespace
}  // namespace marey::draw
