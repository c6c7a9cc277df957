#include "marey/geometry/chi_square.h"

#include <gtest/gtest.h>

namespace marey::geometry {
namespace {

TEST(ChiSquare, QuantilesOfTheTables) {
  EXPECT_NEAR(chi_square_quantile(1, 0.95), 3.841, 5e-4);
  EXPECT_NEAR(chi_square_quantile(2, 0.99), 9.210, 5e-4);
  EXPECT_NEAR(chi_square_quantile(3, 0.99), 11.345, 5e-4);
  EXPECT_NEAR(chi_square_quantile(4, 0.999), 18.467, 5e-4);
  EXPECT_NEAR(chi_square_quantile(5, 0.5), 4.351, 5e-4);
}

}  // namespace
}  // namespace marey::geometry
