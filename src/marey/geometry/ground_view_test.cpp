#include "marey/geometry/ground_view.h"

#include <gtest/gtest.h>

namespace marey::geometry {
namespace {

/// 6 m above the ground, 10 m before the touchline, facing across the pitch and 15° down.
Camera over_the_pitch(const Lens& lens) {
  const double tilt = 15 * M_PI / 180;
  Matrix<3> camera_from_world;  // x along the pitch, y away from the camera, z up
  camera_from_world.row(0) = Vector<3>(1, 0, 0);
  camera_from_world.row(1) = Vector<3>(0, -std::sin(tilt), -std::cos(tilt));
  camera_from_world.row(2) = Vector<3>(0, std::cos(tilt), -std::sin(tilt));
  return {lens, {camera_from_world, -camera_from_world * Vector<3>(0, -10, 6)}, {1920, 1080}};
}

const Lens kLens = BrownLens{{1400, 1400}, {959.5, 539.5}, {-0.2, 0.05}};

void expect_round_trip(const GroundView& view) {
  for (double x = -12; x <= 12; x += 4) {
    for (double y = 5; y <= 65; y += 6) {
      const auto pixel = view.pixel({x, y});
      ASSERT_TRUE(pixel);
      const auto location = view.location(*pixel);
      ASSERT_TRUE(location);
      EXPECT_LT((location->ground - Vector<2>(x, y)).norm(), 1e-6);
      for (int axis = 0; axis < 2; ++axis) {
        const Vector<2> step = 1e-4 * Vector<2>::Unit(axis);
        const Vector<2> slope = (view.location(*pixel + step)->ground - view.location(*pixel - step)->ground) / 2e-4;
        EXPECT_LT((slope - location->by_pixel.col(axis)).norm(), 1e-4 * (1 + slope.norm()));
      }
    }
  }
}

TEST(GroundView, CameraAndHomographyLeadThereAndBack) {
  expect_round_trip(GroundView(over_the_pitch(kLens)));
  const Camera pinhole = over_the_pitch(BrownLens{{1400, 1400}, {959.5, 539.5}, {}});
  Matrix<3> K = Matrix<3>::Identity();
  K << 1400, 0, 959.5, 0, 1400, 539.5, 0, 0, 1;
  Matrix<3> planar = pinhole.camera_from_world().rotation;
  planar.col(2) = pinhole.camera_from_world().translation;
  for (const double scale : {1.0, -0.3}) {
    const GroundView homography((scale * (K * planar)).inverse(), {1920, 1080});
    expect_round_trip(homography);
    EXPECT_LT((*homography.pixel({3, 20}) - *GroundView(pinhole).pixel({3, 20})).norm(), 1e-6);
  }
}

TEST(GroundView, ACrownedGroundLeadsThereAndBack) {
  const Camera camera = over_the_pitch(kLens);
  for (const double ridge : {0.0, 0.7}) {
    const GroundSurface crowned{.middle = {0, 34}, .half = {52.5, 34}, .across = 0.3, .along = 0.2, .dome = 0.1, .ridge = ridge};
    const GroundView view(camera, crowned);
    expect_round_trip(view);
    EXPECT_NEAR(view.surface().height({0, 34}), 0.6, 1e-12);
    const auto pixel = view.pixel({0, 34});
    ASSERT_TRUE(pixel);
    EXPECT_LT((*pixel - *camera.project({0, 34, 0.6})).norm(), 1e-9);
    EXPECT_GT((GroundView(camera).location(*pixel)->ground - Vector<2>(0, 34)).norm(), 3) << "or a plane would do";
  }
}

TEST(GroundView, ALevelSurfaceIsThePlaneToTheLastBit) {
  const Camera camera = over_the_pitch(kLens);
  GroundSurface level;
  level.middle = {3, 7}, level.half = {40, 20}, level.ridge = 0.5;
  for (double x = 0; x < 1920; x += 190) {
    for (double y = 0; y < 1080; y += 107) {
      const auto plane = GroundView(camera).location({x, y}), surface = GroundView(camera, level).location({x, y});
      ASSERT_EQ(plane.has_value(), surface.has_value());
      if (!plane) continue;
      EXPECT_EQ(plane->ground, surface->ground);
      EXPECT_EQ(plane->by_pixel, surface->by_pixel);
    }
  }
}

TEST(GroundView, NothingStandsInTheSkyOrBehindTheCamera) {
  const Camera camera = over_the_pitch(kLens);
  EXPECT_FALSE(GroundView(camera).location({960, 0}));
  EXPECT_FALSE(GroundView(camera).pixel({0, -30}));
}

TEST(GroundView, ACameraBelowItsZAxisSeesTheGroundToo) {
  // A left-handed user frame turned about: z points down and the camera stands at negative z.
  const Camera above = over_the_pitch(kLens);
  Rigid3 flip{Matrix<3>::Identity(), Vector<3>::Zero()};
  flip.rotation.diagonal() << 1, -1, -1;
  expect_round_trip(GroundView(above));
  const GroundView below(Camera(kLens, above.camera_from_world() * flip, {1920, 1080}));
  const auto pixel = below.pixel({3, -20});
  ASSERT_TRUE(pixel);
  EXPECT_LT((below.location(*pixel)->ground - Vector<2>(3, -20)).norm(), 1e-6);
}

}  // namespace
}  // namespace marey::geometry
