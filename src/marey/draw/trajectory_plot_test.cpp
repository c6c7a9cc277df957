#include "marey/draw/trajectory_plot.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace marey::draw {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

Track<2> at(int id, double x, double y) {
  Track<2> track;
  track.id = TrackId{id};
  track.position = {x, y};
  return track;
}

TEST(TrajectoryPlot, DrawsALineForEachTargetAndBreaksItWhereNothingIsKnown) {
  TrajectoryPlot plot;
  for (int frame = 0; frame < 100; ++frame) {
    std::vector<Track<2>> tracks{at(1, 3.0 * frame, 50)};
    if (frame < 30 || frame >= 60) tracks.push_back(at(2, 100, 2.0 * frame));
    plot.add(frame, tracks);
  }
  const std::string svg = plot.to_svg("a <match>");
  EXPECT_EQ(count(svg, "<polyline"), 3u);
  EXPECT_EQ(count(svg, "<circle"), 2u);
  EXPECT_NE(svg.find("a &lt;match&gt;"), std::string::npos);
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
}

TEST(TrajectoryPlot, AnOutlineTellsTheCentre) {
  TrajectoryPlot one, other;
  for (int frame = 0; frame < 20; ++frame) {
    Track<2> track = at(1, 999, 999);
    auto outline = std::make_shared<Outline>();
    outline->centre = {5.0 * frame, 4};
    track.outline = outline;
    one.add(frame, std::vector{track});
    other.add(frame, std::vector{at(1, 5.0 * frame, 4)});
  }
  EXPECT_EQ(one.to_svg(""), other.to_svg(""));
}

TEST(TrajectoryPlot, WhoStandsCostsNoMemoryAndEndsWhereLastSeen) {
  TrajectoryPlot plot;
  for (int frame = 0; frame < 10'000; ++frame) plot.add(frame, std::vector{at(1, 10 + 0.1 * (frame % 3), 10)});
  EXPECT_LT(plot.to_svg("").size(), 4000u);
}

TEST(TrajectoryPlot, OfNobodyIsAPictureToo) {
  EXPECT_EQ(count(TrajectoryPlot().to_svg(""), "<polyline"), 0u);
}

}  // namespace
}  // namespace marey::draw
