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

Sample at(int id, double x, double y) {
  Sample sample;
  sample.track = TrackId{id};
  sample.position = {x, y, 0};
  return sample;
}

Instant instant_of(int frame, std::vector<Sample> samples) {
  Instant instant;
  instant.index = frame;
  instant.samples = std::move(samples);
  return instant;
}

TEST(TrajectoryPlot, DrawsALineForEachTargetAndBreaksItWhereNothingIsKnown) {
  TrajectoryPlot plot;
  for (int frame = 0; frame < 100; ++frame) {
    std::vector<Sample> samples{at(1, 3.0 * frame, 50)};
    if (frame < 30 || frame >= 60) samples.push_back(at(2, 100, 2.0 * frame));
    plot.add(instant_of(frame, samples));
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
    Sample sample = at(1, 999, 999);
    auto outline = std::make_shared<Outline>();
    outline->centre = {5.0 * frame, 4};
    sample.outline = outline;
    one.add(instant_of(frame, {sample}));
    other.add(instant_of(frame, {at(1, 5.0 * frame, 4)}));
  }
  EXPECT_EQ(one.to_svg(""), other.to_svg(""));
}

TEST(TrajectoryPlot, WhoStandsCostsNoMemoryAndEndsWhereLastSeen) {
  TrajectoryPlot plot;
  for (int frame = 0; frame < 10'000; ++frame) plot.add(instant_of(frame, {at(1, 10 + 0.1 * (frame % 3), 10)}));
  EXPECT_LT(plot.to_svg("").size(), 4000u);
}

TEST(TrajectoryPlot, OfNobodyIsAPictureToo) {
  EXPECT_EQ(count(TrajectoryPlot().to_svg(""), "<polyline"), 0u);
}

}  // namespace
}  // namespace marey::draw
