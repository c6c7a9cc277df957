#include "marey/geometry/ground_surface.h"

#include <gtest/gtest.h>

namespace marey::geometry {
namespace {

GroundSurface crowned(double ridge) {
  return {.middle = {52.5, -34}, .half = {52.5, 34}, .across = 0.15, .along = 0.2, .dome = 0.05, .ridge = ridge};
}

TEST(GroundSurface, IsLevelUnlessToldOtherwise) {
  EXPECT_TRUE(GroundSurface{}.flat());
  EXPECT_EQ(GroundSurface{}.height({30, 7}), 0);
  EXPECT_EQ(GroundSurface{}.slope({30, 7}), Vector<2>(0, 0));
}

TEST(GroundSurface, StandsOnItsCornersAndIsHighestInTheMiddle) {
  for (const double ridge : {0.0, 0.4, 1.0}) {
    const GroundSurface ground = crowned(ridge);
    for (const Vector<2>& corner : {Vector<2>(0, 0), Vector<2>(105, 0), Vector<2>(0, -68), Vector<2>(105, -68)})
      EXPECT_NEAR(ground.height(corner), 0, 1e-12);
    EXPECT_NEAR(ground.height({52.5, -34}), 0.4, 1e-12);
    EXPECT_NEAR(ground.height({52.5, 0}), 0.2, 1e-12) << "half of the touchline: as high as the crown along it";
    EXPECT_NEAR(ground.height({0, -34}), 0.15, 1e-12);
    EXPECT_EQ(ground.height({52.5, 20}), ground.height({52.5, 400})) << "level far beyond the lines";
  }
}

TEST(GroundSurface, ItsSlopeIsWhatItsHeightChangesBy) {
  constexpr double step = 1e-5;
  for (const double ridge : {0.0, 0.4, 1.0}) {
    const GroundSurface ground = crowned(ridge);
    for (double x = -20; x <= 125; x += 6.7) {
      for (double y = -90; y <= 20; y += 7.3) {
        const Vector<2> numeric((ground.height({x + step, y}) - ground.height({x - step, y})) / (2 * step),
                                (ground.height({x, y + step}) - ground.height({x, y - step})) / (2 * step));
        EXPECT_LT((ground.slope({x, y}) - numeric).norm(), 1e-8) << x << " " << y;
      }
    }
  }
}

}  // namespace
}  // namespace marey::geometry
