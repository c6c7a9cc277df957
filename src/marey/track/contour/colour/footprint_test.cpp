#include "marey/track/contour/colour/footprint.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace marey::track::contour::colour {
namespace {

TEST(Footprint, CoversThePixelsWhoseCentreIsInside) {
  std::mt19937_64 engine(5);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(engine() >> 11) * 0x1.0p-53);
  };
  for (int repeat = 0; repeat < 50; ++repeat) {
    std::vector<Vector<2>> polygon;
    for (int i = 0; i < 3 + repeat % 9; ++i) polygon.emplace_back(uniform(-9, 30), uniform(-9, 30));
    Footprint footprint;
    footprint.fill(polygon);
    for (int y = -12; y < 34; ++y) {
      for (int x = -12; x < 34; ++x) {
        bool inside = false;  // crossings of the ray to the left
        for (std::size_t i = 0; i < polygon.size(); ++i) {
          const Vector<2>&a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
          if ((a.y() < y) != (b.y() < y) && a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()) <= x) inside = !inside;
        }
        EXPECT_EQ(footprint.covers(x, y), inside) << repeat << ": " << x << " " << y;
      }
    }
  }
}

}  // namespace
}  // namespace marey::track::contour::colour
