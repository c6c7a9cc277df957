#include "marey/draw/trajectory_plot.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "support/text.h"

namespace marey::draw {
namespace {

Sample point_of(int id, double x, double y) {
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
    std::vector<Sample> samples{point_of(1, 3.0 * frame, 50)};
    if (frame < 30 || frame >= 60) samples.push_back(point_of(2, 100, 2.0 * frame));
    plot.add(instant_of(frame, samples));
  }
  const std::string svg = plot.to_svg("a <match>");
  EXPECT_EQ(test::count_of("<polyline", svg), 3u);
  EXPECT_EQ(test::count_of("<circle", svg), 2u);
  EXPECT_NE(svg.find("a &lt;match&gt;"), std::string::npos);
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
}

TEST(TrajectoryPlot, NothingIsMinusNought) {
  TrajectoryPlot plot;
  plot.add(instant_of(0, {point_of(1, -40, -3)}));
  plot.add(instant_of(1, {point_of(1, 60, 90)}));
  const std::string svg = plot.to_svg("way");
  EXPECT_EQ(svg.find(">-0<"), std::string::npos);
  EXPECT_NE(svg.find(">0<"), std::string::npos);
}

TEST(TrajectoryPlot, AnOutlineTellsTheCentre) {
  TrajectoryPlot one, other;
  for (int frame = 0; frame < 20; ++frame) {
    Sample sample = point_of(1, 999, 999);
    auto outline = std::make_shared<Outline>();
    outline->centre = {5.0 * frame, 4};
    sample.outline = outline;
    one.add(instant_of(frame, {sample}));
    other.add(instant_of(frame, {point_of(1, 5.0 * frame, 4)}));
  }
  EXPECT_EQ(one.to_svg(""), other.to_svg(""));
}

TEST(TrajectoryPlot, StandingPersonUsesNoMemoryAndEndsAtLastObservation) {
  TrajectoryPlot plot;
  for (int frame = 0; frame < 10'000; ++frame) plot.add(instant_of(frame, {point_of(1, 10 + 0.1 * (frame % 3), 10)}));
  EXPECT_LT(plot.to_svg("").size(), 4000u);
}

TEST(TrajectoryPlot, OfNobodyIsAPictureToo) {
  EXPECT_EQ(test::count_of("<polyline", TrajectoryPlot().to_svg("")), 0u);
}

}  // namespace
}  // namespace marey::draw
