#include "marey/reconstruct/place_people.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "marey/reconstruct/room_test.h"

namespace marey::reconstruct {
namespace {

/// 7 m above the ground, 14 m before a touchline, looking across a pitch; x along it, y away from the camera.
Camera beside_the_pitch(double tilt_degrees = 12) {
  const double tilt = tilt_degrees * std::numbers::pi / 180;
  Matrix<3> camera_from_world;
  camera_from_world.row(0) = Vector<3>(1, 0, 0);
  camera_from_world.row(1) = Vector<3>(0, -std::sin(tilt), -std::cos(tilt));
  camera_from_world.row(2) = Vector<3>(0, std::cos(tilt), -std::sin(tilt));
  return {geometry::BrownLens{{1500, 1500}, {959.5, 539.5}, {-0.1, 0.02}},
          {camera_from_world, -camera_from_world * Vector<3>(0, -14, 7)},
          {1920, 1080}};
}

GroundView homography_of(const Camera& camera) {
  Matrix<3> K = Matrix<3>::Identity();
  K << 1500, 0, 959.5, 0, 1500, 539.5, 0, 0, 1;
  Matrix<3> planar = camera.camera_from_world().rotation;
  planar.col(2) = camera.camera_from_world().translation;
  return GroundView(Matrix<3>((K * planar).inverse()), camera.size());
}

/// The exact box of somebody `height` tall who stands at `place`.
Box box_of(const Camera& camera, const Vector<2>& place, double height = 1.75) {
  const Vector<2> foot = camera.project({place.x(), place.y(), 0}).value();
  const Vector<2> head = camera.project({place.x(), place.y(), height}).value();
  const double tall = foot.y() - head.y();
  const double wide = 0.35 * tall;
  return {foot.x() - (wide - 1) / 2, head.y() + 0.5, wide, tall};
}

std::optional<Observation<2>> placed(const Box& box, const GroundView& view, std::optional<int> group = {}) {
  Detection one;
  one.box = box;
  one.group = group;
  const auto people = place_people({&one, 1}, view, CameraId{0});
  if (people.seen.empty()) return std::nullopt;
  return people.seen.front();
}

double squared_distance(const Observation<2>& seen, const Vector<2>& truth) {
  const Vector<2> error = seen.value - truth;
  return error.dot(seen.covariance->inverse() * error);
}

TEST(PlacePeople, ExactBoxesLeadToExactPlaces) {
  const Camera camera = beside_the_pitch();
  const Camera straight(geometry::BrownLens{{1500, 1500}, {959.5, 539.5}, {}}, camera.camera_from_world(), camera.size());
  for (double y = 6; y <= 70; y += 8) {
    const Vector<2> place(y / 4, y);
    const auto whole = placed(box_of(camera, place), GroundView(camera));
    ASSERT_TRUE(whole) << y;
    EXPECT_LT((whole->value - place).norm(), 0.05) << y;  // a lens that bends the picture leans people by a pixel
    const auto bare = placed(box_of(straight, place), homography_of(straight));
    ASSERT_TRUE(bare);
    EXPECT_LT((bare->value - place).norm(), 1e-6) << y;
  }
}

TEST(PlacePeople, OnACrownedPitchPeopleStandOnTheCrown) {
  const Camera camera(geometry::BrownLens{{1500, 1500}, {959.5, 539.5}, {}}, beside_the_pitch().camera_from_world(), {1920, 1080});
  const geometry::GroundSurface crowned{.middle = {0, 34}, .half = {52.5, 34}, .across = 0.3, .along = 0.2};
  for (double y = 6; y <= 62; y += 8) {
    const Vector<2> place(y / 4, y);
    const double floor = crowned.height(place);
    const Vector<2> foot = camera.project({place.x(), place.y(), floor}).value();
    const Vector<2> head = camera.project({place.x(), place.y(), floor + 1.75}).value();
    const double tall = foot.y() - head.y(), wide = 0.35 * tall;
    const Box box{foot.x() - (wide - 1) / 2, head.y() + 0.5, wide, tall};
    const auto on_crown = placed(box, GroundView(camera, crowned)), on_plane = placed(box, GroundView(camera));
    ASSERT_TRUE(on_crown && on_plane);
    EXPECT_LT((on_crown->value - place).norm(), 0.02) << y;
    EXPECT_GT((on_plane->value - place).norm(), 0.2) << y << ": or the crown would not matter";
    // Feet cut off by the picture's border: the head alone says where, and stands on the crown too.
    const Camera cut(camera.lens(), camera.camera_from_world(), {1920, static_cast<int>(foot.y() - 0.3 * tall)});
    const Box shown{box.left, box.top, box.width, cut.size().height - box.top};
    const auto by_head = placed(shown, GroundView(cut, crowned)), by_head_on_plane = placed(shown, GroundView(cut));
    ASSERT_TRUE(by_head && by_head_on_plane);
    EXPECT_LT((by_head->value - place).norm(), 0.1) << y;  // heads lean aside in a picture
    EXPECT_GT((by_head_on_plane->value - place).norm(), 0.2) << y;
  }
}

TEST(PlacePeople, ABoxThatEndsAtTheTipOfTheFootIsPlacedBehindIt) {
  const Camera camera(geometry::BrownLens{{1500, 1500}, {959.5, 539.5}, {}}, beside_the_pitch().camera_from_world(), {1920, 1080});
  for (double y = 6; y <= 70; y += 8) {
    const Vector<2> from_camera = Vector<2>(y / 4, y) - Vector<2>(0, -14);
    const Vector<2> place(y / 4, y), tip = place - 0.1 * from_camera.normalized();
    Box box = box_of(camera, place);
    box.height += camera.project({tip.x(), tip.y(), 0})->y() - camera.project({place.x(), place.y(), 0})->y();
    Detection one;
    one.box = box;
    for (const GroundView& view : {GroundView(camera), homography_of(camera)}) {
      const auto people = place_people({&one, 1}, view, CameraId{0}, {.toe = 0.1});
      ASSERT_EQ(people.seen.size(), 1U);
      EXPECT_LT((people.seen.front().value - place).norm(), 0.03) << y;
    }
  }
}

TEST(PlacePeople, SaysHowFarItMayBeWrong) {
  const PlacePeopleOptions options;
  const Camera bent = beside_the_pitch();
  const Camera straight(geometry::BrownLens{{1500, 1500}, {959.5, 539.5}, {}}, bent.camera_from_world(), bent.size());
  room::Random random(1);
  for (const double y : {8.0, 30.0, 65.0}) {
    const Vector<2> place(0.2 * y, y);
    for (const bool whole : {true, false}) {
      const Camera& camera = whole ? bent : straight;
      const GroundView view = whole ? GroundView(camera) : homography_of(camera);
      constexpr int runs = 4000;
      double squared = 0;
      Vector<2> bias = Vector<2>::Zero();
      Matrix<2> covariance = Matrix<2>::Zero();
      for (int i = 0; i < runs; ++i) {
        const Vector<2> stood = place + random.gaussian_2d(options.stride);
        Box box = box_of(camera, stood, options.height + random.gaussian(options.height_spread));
        const double sigma = std::hypot(options.pixel_noise, options.edge_noise * box.height);
        const double top = box.top + random.gaussian(sigma);
        box = {box.left + random.gaussian(sigma / std::sqrt(2.0)), top, box.width, box.bottom() + random.gaussian(sigma) - top};
        const auto seen = placed(box, view);
        ASSERT_TRUE(seen);
        squared += squared_distance(*seen, place);
        bias += (seen->value - place) / runs;
        covariance = seen->covariance.value();
      }
      EXPECT_LT(bias.norm(), 0.12 * std::sqrt(covariance.trace())) << y << " m away, whole camera " << whole;
      EXPECT_NEAR(squared / runs / 2, 1, 0.15) << y << " m away, whole camera " << whole;
    }
  }
}

TEST(PlacePeople, TheHeadMakesThePlaceSurer) {
  const Camera camera = beside_the_pitch();
  const Camera straight(geometry::BrownLens{{1500, 1500}, {959.5, 539.5}, {}}, camera.camera_from_world(), camera.size());
  const Box box = box_of(straight, {5, 50});
  const auto whole = placed(box, GroundView(straight));
  const auto bare = placed(box, homography_of(straight));
  EXPECT_LT(whole->covariance->determinant(), 0.95 * bare->covariance->determinant());
}

TEST(PlacePeople, WhoseLegsAreHiddenIsPlacedByTheHead) {
  const Camera camera = beside_the_pitch();
  const Vector<2> behind(2, 24), before(2.1, 20);
  std::vector<Detection> seen(2);
  seen[0].box = box_of(camera, behind);
  seen[1].box = box_of(camera, before);
  seen[0].box.height = 0.45 * seen[0].box.height;
  const auto people = place_people(seen, GroundView(camera), CameraId{3});
  ASSERT_EQ(people.seen.size(), 2U);
  EXPECT_LT((people.seen[0].value - behind).norm(), 0.2);
  EXPECT_LT((people.seen[1].value - before).norm(), 0.1);
  EXPECT_EQ(people.seen[0].camera, CameraId{3});
  // Alone, a short box is somebody who bends down: the feet are believed.
  const auto bent = placed(seen[0].box, GroundView(camera));
  const auto foot = GroundView(camera).place(seen[0].box.foot());
  EXPECT_LT((bent->value - foot->ground).norm(), 1e-9);
}

TEST(PlacePeople, WhatThePictureCutsIsDoubted) {
  const Camera camera = beside_the_pitch(35);
  const GroundView view(camera);
  const Vector<2> place(0, -2);
  Box box = box_of(camera, place);
  const double whole = placed(box, view)->covariance->trace();
  const double cut = box.bottom() - 1079.5;
  ASSERT_LT(cut, 0) << "the scene must hold all of him";
  const Camera shorter(camera.lens(), camera.camera_from_world(), {1920, static_cast<int>(box.bottom()) - 40});
  box.height = shorter.size().height - box.top;
  const auto seen = placed(box, GroundView(shorter));
  ASSERT_TRUE(seen);
  EXPECT_LT((seen->value - place).norm(), 0.2);
  EXPECT_GT(seen->covariance->trace(), whole);
  const Box side{-0.5, box_of(camera, place).top, 20, 80};
  Box inside = side;
  inside.left = 50;
  EXPECT_GT(placed(side, view)->covariance->trace(), placed(inside, view)->covariance->trace());
}

TEST(PlacePeople, ASharedRegionCoversItsPeople) {
  const Camera camera = beside_the_pitch();
  const Vector<2> left(-0.5, 30), right(0.5, 30.4);
  const Box both = geometry::hull(box_of(camera, left), box_of(camera, right));
  const auto seen = placed(both, GroundView(camera), 1);
  ASSERT_TRUE(seen);
  EXPECT_TRUE(seen->shared);
  EXPECT_LT(squared_distance(*seen, left), 6);
  EXPECT_LT(squared_distance(*seen, right), 6);
}

TEST(PlacePeople, NobodyStandsInTheSky) {
  const Camera camera = beside_the_pitch(2);
  EXPECT_FALSE(placed({900, 10, 20, 60}, GroundView(camera)));
  EXPECT_FALSE(placed({900, 900, 0, 60}, GroundView(camera)));
}

}  // namespace
}  // namespace marey::reconstruct
