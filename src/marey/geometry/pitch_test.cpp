#include "marey/geometry/pitch.h"

#include <limits>

#include <gtest/gtest.h>

namespace marey::geometry {
namespace {

TEST(Pitch, EverySampleLiesOnALine) {
  const PitchSize size{100, 64};
  const auto lines = pitch_lines(size, 0.25);
  EXPECT_EQ(lines.size(), 20u);
  for (const PitchLine& line : lines) {
    ASSERT_EQ(line.points.size(), line.tangents.size());
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      EXPECT_LT(distance_to_line(size, line.points[i]), 1e-9) << line.name;
      EXPECT_NEAR(line.tangents[i].norm(), 1, 1e-12);
      if (i > 0) {
        const Vector<2> step = line.points[i] - line.points[i - 1];
        EXPECT_LE(step.norm(), 0.2501);
        EXPECT_GT(step.normalized().dot(line.tangents[i]), 0.999) << line.name;
      }
    }
  }
}

TEST(Pitch, DistanceIsThatOfTheNearestSample) {
  const PitchSize size;
  const auto lines = pitch_lines(size, 0.01);
  for (double x = -3; x < 110; x += 7.3) {
    for (double y = -3; y < 72; y += 5.9) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const PitchLine& line : lines) {
        for (const Vector<2>& point : line.points) nearest = std::min(nearest, (point - Vector<2>(x, y)).norm());
      }
      EXPECT_NEAR(distance_to_line(size, {x, y}), nearest, 0.01) << x << " " << y;
    }
  }
}

TEST(Pitch, TheLawsMeasures) {
  const PitchSize size;
  EXPECT_NEAR(distance_to_line(size, {16.5, 13.84}), 0, 1e-9);
  EXPECT_NEAR(distance_to_line(size, {105 - 5.5, 43.16}), 0, 1e-9);
  EXPECT_NEAR(distance_to_line(size, {52.5 + 9.15, 34}), 0, 1e-9);
  EXPECT_NEAR(distance_to_line(size, {11 + 9.15, 34}), 0, 1e-9);
  EXPECT_NEAR(distance_to_line(size, {11, 34}), 5.5, 1e-9) << "the penalty mark is not a line";
}

}  // namespace
}  // namespace marey::geometry
