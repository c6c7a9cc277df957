#include "marey/reconstruct/place_people.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "marey/reconstruct/room_test.h"

namespace marey::reconstruct {
namespace {

/// 7 m above the ground, 14 m before a touchline, facing across a pitch; x along it, y away from the camera.
Camera camera_by_touchline(double tilt_degrees = 12) {
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

/// The exact box of a person `height` tall who stands at `place`.
Box box_of(const Camera& camera, const Vector<2>& location, double height = 1.75) {
  const Vector<2> foot = camera.project({location.x(), location.y(), 0}).value();
  const Vector<2> head = camera.project({location.x(), location.y(), height}).value();
  const double tall = foot.y() - head.y();
  const double wide = 0.35 * tall;
  return {foot.x() - (wide - 1) / 2, head.y() + 0.5, wide, tall};
}

std::optional<Observation<2>> located(const Box& box, const GroundView& view, std::optional<int> group = {}) {
  Detection one;
  one.box = box;
  one.group = group;
  const auto people = localise_people({&one, 1}, view, CameraId{0});
  if (people.detected.empty()) return std::nullopt;
  return people.detected.front();
}

double squared_distance(const Observation<2>& detected, const Vector<2>& truth) {
  const Vector<2> error = detected.value - truth;
  return error.dot(detected.covariance->inverse() * error);
}

TEST(PlacePeople, ExactBoxesLeadToExactPlaces) {
  const Camera camera = camera_by_touchline();
  const Camera straight(geometry::BrownLens{{1500, 1500}, {959.5, 539.5}, {}}, camera.camera_from_world(), camera.size());
  for (double y = 6; y <= 70; y += 8) {
    const Vector<2> location(y / 4, y);
    const auto whole = located(box_of(camera, location), GroundView(camera));
    ASSERT_TRUE(whole) << y;
    EXPECT_LT((whole->value - location).norm(), 0.05) << y;  // a lens that bends the image leans people by a pixel
    const auto bare = located(box_of(straight, location), homography_of(straight));
    ASSERT_TRUE(bare);
    EXPECT_LT((bare->value - location).norm(), 1e-6) << y;
  }
}

TEST(PlacePeople, OnACrownedPitchPeopleStandOnTheCrown) {
  const Camera camera(geometry::BrownLens{{1500, 1500}, {959.5, 539.5}, {}}, camera_by_touchline().camera_from_world(),
                      {1920, 1080});
  const geometry::GroundSurface crowned{.middle = {0, 34}, .half = {52.5, 34}, .across = 0.3, .along = 0.2};
  for (double y = 6; y <= 62; y += 8) {
    const Vector<2> location(y / 4, y);
    const double floor = crowned.height(location);
    const Vector<2> foot = camera.project({location.x(), location.y(), floor}).value();
    const Vector<2> head = camera.project({location.x(), location.y(), floor + 1.75}).value();
    const double tall = foot.y() - head.y(), wide = 0.35 * tall;
    const Box box{foot.x() - (wide - 1) / 2, head.y() + 0.5, wide, tall};
    const auto on_crown = located(box, GroundView(camera, crowned)), on_plane = located(box, GroundView(camera));
    ASSERT_TRUE(on_crown && on_plane);
    EXPECT_LT((on_crown->value - location).norm(), 0.02) << y;
    EXPECT_GT((on_plane->value - location).norm(), 0.2) << y << ": or the crown would not matter";
    // Feet cut off by the image's border: the head alone says where, and stands on the crown too.
    const Camera cut(camera.lens(), camera.camera_from_world(), {1920, static_cast<int>(foot.y() - 0.3 * tall)});
    const Box shown{box.left, box.top, box.width, cut.size().height - box.top};
    const auto by_head = located(shown, GroundView(cut, crowned)), by_head_on_plane = located(shown, GroundView(cut));
    ASSERT_TRUE(by_head && by_head_on_plane);
    EXPECT_LT((by_head->value - location).norm(), 0.1) << y;  // heads lean aside in an image
    EXPECT_GT((by_head_on_plane->value - location).norm(), 0.2) << y;
  }
}

TEST(PlacePeople, ABoxThatEndsAtTheTipOfTheFootIsPlacedBehindIt) {
  const Camera camera(geometry::BrownLens{{1500, 1500}, {959.5, 539.5}, {}}, camera_by_touchline().camera_from_world(),
                      {1920, 1080});
  for (double y = 6; y <= 70; y += 8) {
    const Vector<2> from_camera = Vector<2>(y / 4, y) - Vector<2>(0, -14);
    const Vector<2> location(y / 4, y), tip = location - 0.1 * from_camera.normalized();
    Box box = box_of(camera, location);
    box.height += camera.project({tip.x(), tip.y(), 0})->y() - camera.project({location.x(), location.y(), 0})->y();
    Detection one;
    one.box = box;
    for (const GroundView& view : {GroundView(camera), homography_of(camera)}) {
      const auto people = localise_people({&one, 1}, view, CameraId{0}, {.toe = 0.1});
      ASSERT_EQ(people.detected.size(), 1U);
      EXPECT_LT((people.detected.front().value - location).norm(), 0.03) << y;
    }
  }
}

TEST(PlacePeople, SaysHowFarItMayBeWrong) {
  const LocalisePeopleOptions options;
  const Camera bent = camera_by_touchline();
  const Camera straight(geometry::BrownLens{{1500, 1500}, {959.5, 539.5}, {}}, bent.camera_from_world(), bent.size());
  room::Random random(1);
  for (const double y : {8.0, 30.0, 65.0}) {
    const Vector<2> location(0.2 * y, y);
    for (const bool whole : {true, false}) {
      const Camera& camera = whole ? bent : straight;
      const GroundView view = whole ? GroundView(camera) : homography_of(camera);
      constexpr int runs = 4000;
      double squared = 0;
      Vector<2> bias = Vector<2>::Zero();
      Matrix<2> covariance = Matrix<2>::Zero();
      for (int i = 0; i < runs; ++i) {
        const Vector<2> stood = location + random.gaussian_2d(options.stride);
        Box box = box_of(camera, stood, options.height + random.gaussian(options.height_spread));
        const double sigma = std::hypot(options.pixel_noise, options.edge_noise * box.height);
        const double top = box.top + random.gaussian(sigma);
        box = {box.left + random.gaussian(sigma / std::sqrt(2.0)), top, box.width, box.bottom() + random.gaussian(sigma) - top};
        const auto detected = located(box, view);
        ASSERT_TRUE(detected);
        squared += squared_distance(*detected, location);
        bias += (detected->value - location) / runs;
        covariance = detected->covariance.value();
      }
      EXPECT_LT(bias.norm(), 0.12 * std::sqrt(covariance.trace())) << y << " m away, whole camera " << whole;
      EXPECT_NEAR(squared / runs / 2, 1, 0.15) << y << " m away, whole camera " << whole;
    }
  }
}

TEST(PlacePeople, TheHeadMakesThePlaceSurer) {
  const Camera camera = camera_by_touchline();
  const Camera straight(geometry::BrownLens{{1500, 1500}, {959.5, 539.5}, {}}, camera.camera_from_world(), camera.size());
  const Box box = box_of(straight, {5, 50});
  const auto whole = located(box, GroundView(straight));
  const auto bare = located(box, homography_of(straight));
  EXPECT_LT(whole->covariance->determinant(), 0.95 * bare->covariance->determinant());
}

TEST(PlacePeople, LocalisesOccludedLegsByHead) {
  const Camera camera = camera_by_touchline();
  const Vector<2> behind(2, 24), before(2.1, 20);
  std::vector<Detection> detected(2);
  detected[0].box = box_of(camera, behind);
  detected[1].box = box_of(camera, before);
  detected[0].box.height = 0.45 * detected[0].box.height;
  const auto people = localise_people(detected, GroundView(camera), CameraId{3});
  ASSERT_EQ(people.detected.size(), 2U);
  EXPECT_LT((people.detected[0].value - behind).norm(), 0.2);
  EXPECT_LT((people.detected[1].value - before).norm(), 0.1);
  EXPECT_EQ(people.detected[0].camera, CameraId{3});
  // Alone, a short box is a person who bends down: the feet are trusted.
  const auto bent = located(detected[0].box, GroundView(camera));
  const auto foot = GroundView(camera).location(detected[0].box.foot());
  EXPECT_LT((bent->value - foot->ground).norm(), 1e-9);
}

TEST(PlacePeople, MarksTruncatedBoxAsUncertain) {
  const Camera camera = camera_by_touchline(35);
  const GroundView view(camera);
  const Vector<2> location(0, -2);
  Box box = box_of(camera, location);
  const double whole = located(box, view)->covariance->trace();
  const double cut = box.bottom() - 1079.5;
  ASSERT_LT(cut, 0) << "the scene must hold all of him";
  const Camera shorter(camera.lens(), camera.camera_from_world(), {1920, static_cast<int>(box.bottom()) - 40});
  box.height = shorter.size().height - box.top;
  const auto detected = located(box, GroundView(shorter));
  ASSERT_TRUE(detected);
  EXPECT_LT((detected->value - location).norm(), 0.2);
  EXPECT_GT(detected->covariance->trace(), whole);
  const Box side{-0.5, box_of(camera, location).top, 20, 80};
  Box inside = side;
  inside.left = 50;
  EXPECT_GT(located(side, view)->covariance->trace(), located(inside, view)->covariance->trace());
}

TEST(PlacePeople, ASharedRegionCoversItsPeople) {
  const Camera camera = camera_by_touchline();
  const Vector<2> left(-0.5, 30), right(0.5, 30.4);
  const Box both = geometry::hull(box_of(camera, left), box_of(camera, right));
  const auto detected = located(both, GroundView(camera), 1);
  ASSERT_TRUE(detected);
  EXPECT_TRUE(detected->shared);
  EXPECT_LT(squared_distance(*detected, left), 6);
  EXPECT_LT(squared_distance(*detected, right), 6);
}

TEST(PlacePeople, RejectsPositionsAboveHorizon) {
  const Camera camera = camera_by_touchline(2);
  EXPECT_FALSE(located({900, 10, 20, 60}, GroundView(camera)));
  EXPECT_FALSE(located({900, 900, 0, 60}, GroundView(camera)));
}

}  // namespace
}  // namespace marey::reconstruct
