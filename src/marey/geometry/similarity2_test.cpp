#include "marey/geometry/similarity2.h"

#include <gtest/gtest.h>

namespace marey::geometry {
namespace {

TEST(Similarity2, TurnsAboutItsCentre) {
  const Similarity2 motion = Similarity2::about({100, 50}, 2, 0.3, {5, -7});
  EXPECT_NEAR((motion * Vector<2>(100, 50) - Vector<2>(105, 43)).norm(), 0, 1e-12);
  EXPECT_NEAR(motion.scale(), 2, 1e-12);
  const Vector<2> arm = motion * Vector<2>(101, 50) - Vector<2>(105, 43);
  EXPECT_NEAR(arm.norm(), 2, 1e-12);
  EXPECT_NEAR(std::atan2(arm.y(), arm.x()), 0.3, 1e-12);
}

TEST(Similarity2, IsUndoneByItsInverse) {
  const Similarity2 first = Similarity2::about({10, 20}, 1.5, -0.4, {3, 4}), second = Similarity2::about({0, 9}, 0.7, 1.1, {-8, 1});
  const Vector<2> point(123, -45);
  EXPECT_NEAR((first.inverse() * (first * point) - point).norm(), 0, 1e-10);
  EXPECT_NEAR(((second * first) * point - second * (first * point)).norm(), 0, 1e-10);
}

TEST(Similarity2, KeepsBoxesUpright) {
  const Box box = Similarity2::about({0, 0}, 2, 0, {10, 0}) * Box{5, 5, 11, 21};
  EXPECT_NEAR(box.width, 22, 1e-12);
  EXPECT_NEAR(box.height, 42, 1e-12);
  EXPECT_NEAR(box.centre().x(), 30, 1e-12);
}

}  // namespace
}  // namespace marey::geometry
