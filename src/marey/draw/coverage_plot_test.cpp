#include "marey/draw/coverage_plot.h"

#include <gtest/gtest.h>

namespace marey::draw {
namespace {

TEST(CoveragePlot, ShowsMarksErrorsAndEmptyFields) {
  CoveragePlot plot{"left <camera>", {1000, 800}, {}};
  for (int i = 0; i < 5; ++i) plot.marks.push_back({{50.0 + i, 60}, {0.1, 0}, true});
  plot.marks.push_back({{900, 700}, {5, 5}, false});
  const std::string svg = to_svg(plot);
  EXPECT_NE(svg.find("left &lt;camera&gt;"), std::string::npos);
  EXPECT_NE(svg.find("drawn 100 times"), std::string::npos);
  EXPECT_NE(svg.find("#d22"), std::string::npos);
  std::size_t empty = 0;
  for (std::size_t at = 0; (at = svg.find("fill=\"#fff\" fill-opacity", at)) != std::string::npos; ++at) ++empty;
  EXPECT_EQ(empty, 79U);  // of 10 × 8 fields, one was seen and used
}

}  // namespace
}  // namespace marey::draw
