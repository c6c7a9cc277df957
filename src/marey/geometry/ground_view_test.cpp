#include "marey/geometry/ground_view.h"

#include <gtest/gtest.h>

namespace marey::geometry {
namespace {

/// 6 m above the ground, 10 m before the touchline, looking across the pitch and 15° down.
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
      const auto place = view.place(*pixel);
      ASSERT_TRUE(place);
      EXPECT_LT((place->ground - Vector<2>(x, y)).norm(), 1e-6);
      for (int axis = 0; axis < 2; ++axis) {
        const Vector<2> step = 1e-4 * Vector<2>::Unit(axis);
        const Vector<2> slope = (view.place(*pixel + step)->ground - view.place(*pixel - step)->ground) / 2e-4;
        EXPECT_LT((slope - place->by_pixel.col(axis)).norm(), 1e-4 * (1 + slope.norm()));
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

TEST(GroundView, NothingStandsInTheSkyOrBehindTheCamera) {
  const Camera camera = over_the_pitch(kLens);
  EXPECT_FALSE(GroundView(camera).place({960, 0}));
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
  EXPECT_LT((below.place(*pixel)->ground - Vector<2>(3, -20)).norm(), 1e-6);
}

}  // namespace
}  // namespace marey::geometry
