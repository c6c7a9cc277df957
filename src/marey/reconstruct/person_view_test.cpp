#include "marey/reconstruct/person_view.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace marey::reconstruct {
namespace {

/// 10 m up at the origin, facing along y and 20° down.
Camera camera_on_a_mast() {
  const double down = 20 * M_PI / 180;
  Matrix<3> R;
  R << 1, 0, 0, 0, -std::sin(down), -std::cos(down), 0, std::cos(down), -std::sin(down);
  const Vector<3> centre(0, 0, 10);
  return {geometry::BrownLens{.focal = {1000, 1000}, .principal = {959.5, 539.5}}, Rigid3{R, -R * centre}, {1920, 1080}};
}

TEST(PersonView, TheBoxGoesFromTheFeetToTheCrown) {
  const Camera camera = camera_on_a_mast();
  const PersonShape shape;
  for (const Vector<2>& location : {Vector<2>(0, 25), Vector<2>(5, 40), Vector<2>(-15, 60)}) {
    const auto box = person_box(camera, {location.x(), location.y(), 0}, shape);
    ASSERT_TRUE(box);
    const auto feet = camera.project({location.x(), location.y(), 0});
    const auto crown = camera.project({location.x(), location.y(), shape.height});
    EXPECT_NEAR(box->foot().y(), feet->y(), 0.51);
    EXPECT_NEAR(box->top, crown->y(), 0.51);
    EXPECT_NEAR(box->centre().x(), (feet->x() + crown->x()) / 2, 1e-9);
    EXPECT_NEAR(box->width / box->height, shape.width / shape.height, 0.1);
  }
}

TEST(PersonView, RejectsPositionsBehindCamera) {
  EXPECT_FALSE(person_box(camera_on_a_mast(), {0, -30, 0}));
}

}  // namespace
}  // namespace marey::reconstruct
