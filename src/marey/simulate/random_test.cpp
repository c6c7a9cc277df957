#include "marey/simulate/random.h"

#include <gtest/gtest.h>

namespace marey::simulate {
namespace {

TEST(Random, SameSeedSameNumbers) {
  Random a(7), b(7), c(8);
  const double first = a.uniform();
  EXPECT_EQ(first, b.uniform());
  EXPECT_NE(first, c.uniform());
}

TEST(Random, MomentsAreThoseOfTheDistributions) {
  Random random(1);
  constexpr int kCount = 200'000;
  double sum = 0, squares = 0, uniform = 0;
  int sixes = 0;
  for (int i = 0; i < kCount; ++i) {
    const double value = random.gaussian(3, 2);
    sum += value;
    squares += (value - 3) * (value - 3);
    uniform += random.uniform(-1, 3);
    const int die = random.integer(1, 6);
    ASSERT_GE(die, 1);
    ASSERT_LE(die, 6);
    sixes += die == 6 ? 1 : 0;
  }
  EXPECT_NEAR(sum / kCount, 3, 0.02);
  EXPECT_NEAR(squares / kCount, 4, 0.06);
  EXPECT_NEAR(uniform / kCount, 1, 0.01);
  EXPECT_NEAR(sixes / static_cast<double>(kCount), 1.0 / 6, 0.004);
}

}  // namespace
}  // namespace marey::simulate
