#include "marey/draw/chart.h"

#include <gtest/gtest.h>

#include "support/text.h"

namespace marey::draw {
namespace {

TEST(Chart, BarsHaveHeightsInProportionAndMissingOnesAreNotDrawn) {
  BarChart chart;
  chart.title = "Losses < 20 & more";
  chart.series = {"paper", "ours"};
  chart.groups = {{"slow", {Bar{4, {}, {}}, Bar{2, 1.0, 3.0}}}, {"rapid", {std::nullopt, Bar{0, {}, {}}}}};
  const std::string svg = to_svg(chart);
  EXPECT_EQ(test::count_of("<title>", svg), 3u);
  EXPECT_NE(svg.find("Losses &lt; 20 &amp; more"), std::string::npos);
  EXPECT_NE(svg.find(R"(height="270")"), std::string::npos) << "the largest bar reaches the top of a 0-4 axis";
  EXPECT_NE(svg.find(R"(height="135")"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(Chart, LinesGoThroughTheirPointsOnBothKindsOfAxis) {
  LineChart chart;
  chart.lines = {{"a", {{1, 0.01}, {30, 1}}}};
  for (const bool logarithmic : {false, true}) {
    chart.logarithmic_y = logarithmic;
    const std::string svg = to_svg(chart);
    EXPECT_EQ(test::count_of("<circle", svg), 2u);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
  }
}

TEST(Chart, AnEmptyChartIsStillAPicture) {
  EXPECT_EQ(test::count_of("</svg>", to_svg(LineChart{})), 1u);
  EXPECT_EQ(test::count_of("</svg>", to_svg(BarChart{})), 1u);
}

}  // namespace
}  // namespace marey::draw
