#include "marey/detect/people/person_size_map.h"

#include <gtest/gtest.h>

namespace marey::detect::people {
namespace {

/// People grow downwards, and no person stands above row 100.
std::optional<PersonSize> rising(double /*x*/, double y) {
  if (y < 100) return std::nullopt;
  return PersonSize{20 + 0.2 * y, 8 + 0.08 * y};
}

TEST(PersonSizeMap, BetweenItsPlacesSizesAreThoseItWasTold) {
  const PersonSizeMap map({640, 480}, rising);
  for (const double y : {130.0, 201.7, 333.3, 479.0, 520.0}) {
    for (const double x : {-40.0, 0.0, 317.3, 639.0, 700.0}) {
      const auto size = map.at(x, y);
      ASSERT_TRUE(size) << x << " " << y;
      EXPECT_NEAR(size->height, rising(x, y)->height, 1e-9);
      EXPECT_NEAR(size->width, rising(x, y)->width, 1e-9);
    }
  }
}

TEST(PersonSizeMap, NoPersonAtImpossiblePosition) {
  const PersonSizeMap map({640, 480}, rising);
  EXPECT_FALSE(map.at(320, 60));
  EXPECT_FALSE(map.at(320, -50));
  EXPECT_FALSE(map.at(1e6, 300)) << "far outside of the image";
  EXPECT_FALSE(map.at(320, 1e6));
}

}  // namespace
}  // namespace marey::detect::people
