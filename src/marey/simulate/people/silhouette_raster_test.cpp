#include "marey/simulate/people/silhouette_raster.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "marey/simulate/random.h"

namespace marey::simulate::people {
namespace {

/// Within the hull of two discs: within the disc that lies between them, somewhere.
bool inside(const RoundCone2& shape, const Vector<2>& at) {
  for (int i = 0; i <= 2000; ++i) {
    const double t = i / 2000.0;
    const Vector<2> centre = (1 - t) * shape.from + t * shape.to;
    if ((at - centre).norm() <= (1 - t) * shape.from_radius + t * shape.to_radius) return true;
  }
  return false;
}

TEST(SilhouetteRaster, RoundConesAgreeWithBruteForce) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    const auto location = [&] { return Vector<2>(random.uniform(-6, 14), random.uniform(-6, 14)); };
    const RoundCone2 shape{location(), location(), random.uniform(0.2, 5), random.uniform(0.2, 5)};
    Silhouette silhouette = blank_silhouette(bounds(shape), 3);
    fill(silhouette, shape, 7);
    int wrong = 0, marked = 0;
    for (int row = 0; row < silhouette.mask.rows; ++row) {
      for (int column = 0; column < silhouette.mask.cols; ++column) {
        const Vector<2> at((silhouette.lattice.x + column + 0.5) / 3 - 0.5, (silhouette.lattice.y + row + 0.5) / 3 - 0.5);
        const bool is = silhouette.mask.at<std::uint8_t>(row, column) == 7;
        wrong += is != inside(shape, at) ? 1 : 0;
        marked += is ? 1 : 0;
      }
    }
    EXPECT_LE(wrong, marked / 500 + 1) << "seed " << seed;  // points within a thousandth of the rim
    EXPECT_GT(marked, 0);
  }
}

TEST(SilhouetteRaster, ADiscHasItsAreaCentreAndBox) {
  const RoundCone2 disc{{20.3, 11.7}, {20.3, 11.7}, 6, 6};
  Silhouette silhouette = blank_silhouette(bounds(disc), 8);
  fill(silhouette, disc, 1);
  EXPECT_NEAR(silhouette.area(), 36 * M_PI, 0.5);
  EXPECT_NEAR(silhouette.centre().x(), 20.3, 0.02);
  EXPECT_NEAR(silhouette.centre().y(), 11.7, 0.02);
  EXPECT_NEAR(silhouette.box().centre().x(), 20.3, 0.1);
  EXPECT_NEAR(silhouette.box().width, 12, 0.2);
  EXPECT_NEAR(cv::countNonZero(silhouette.pixel_mask({64, 48})), 36 * M_PI, 6);
}

TEST(SilhouetteRaster, RemovesSubtractedAndClippedParts) {
  const RoundCone2 behind{{5, 5}, {5, 5}, 4, 4}, front{{8, 5}, {8, 5}, 4, 4};
  Silhouette a = blank_silhouette(bounds(behind), 4), b = blank_silhouette(bounds(front), 4);
  fill(a, behind, 1);
  fill(b, front, 1);
  const double before = a.area();
  take_away(a, b);
  // Two circles of radius 4, 3 apart, share 2 r² acos(d / 2r) − d/2 √(4r² − d²).
  EXPECT_NEAR(before - a.area(), 2 * 16 * std::acos(3.0 / 8) - 1.5 * std::sqrt(64 - 9.0), 0.5);
  crop(a, {5, 40});
  EXPECT_LE(a.box().right(), 5);
  crop(a, {0, 0});
  EXPECT_TRUE(a.empty());
  EXPECT_EQ(a.area(), 0);
}

}  // namespace
}  // namespace marey::simulate::people
