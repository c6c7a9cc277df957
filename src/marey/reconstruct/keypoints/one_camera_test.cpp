#include "marey/reconstruct/keypoints/one_camera.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "marey/core/keypoint_sets.h"

namespace marey::reconstruct::keypoints {
namespace {

/// 2 m above the floor at the origin, facing along y and 10° down.
Camera camera_above_floor() {
  const double tilt = 10 * M_PI / 180;
  Matrix<3> rotation;  // camera_from_world: x right, y down, z ahead
  rotation << 1, 0, 0, 0, -std::sin(tilt), -std::cos(tilt), 0, std::cos(tilt), -std::sin(tilt);
  geometry::BrownLens lens;
  lens.focal = {1000, 1000};
  lens.principal = {640, 360};
  return {lens, Rigid3{rotation, Vector<3>(-(rotation * Vector<3>(0, 0, 2)))}, cv::Size(1280, 720)};
}

const KeypointSet& set() {
  return keypoint_set_named("body_25b");
}

/// A body in the vertical plane through `place` that faces the camera; `lift` is how high the left foot is above the floor.
std::vector<Vector<3>> flat_body(const Vector<3>& location, double lift = 0) {
  const Vector<3> towards(-location.x(), -location.y(), 0), across = Vector<3>(towards.y(), -towards.x(), 0).normalized();
  std::vector<Vector<3>> points;
  for (std::size_t i = 0; i < set().points.size(); ++i) {
    const std::string& name = set().points[i];
    const double side = name.starts_with("left") ? 0.15 : name.starts_with("right") ? -0.15 : 0;
    double height = 0.3 + 0.06 * static_cast<double>(i);
    if (name.ends_with("ankle")) height = 0.08;
    if (name.ends_with("heel")) height = 0.03;
    if (name.ends_with("toe")) height = 0.02;
    const bool foot = name.ends_with("ankle") || name.ends_with("heel") || name.ends_with("toe");
    if (foot && side > 0) height += lift;
    points.emplace_back(location + side * across + Vector<3>(0, 0, height));
  }
  return points;
}

Keypoints<2> observed_by(const Camera& camera, const std::vector<Vector<3>>& points) {
  Keypoints<2> body;
  for (const Vector<3>& point : points) {
    const auto pixel = camera.project(point);
    body.points.push_back(pixel ? std::optional(Keypoint<2>{.position = *pixel, .covariance = 4 * Matrix<2>::Identity()})
                                : std::nullopt);
  }
  return body;
}

TEST(PeopleBeforeCamera, PlacesAFlatBodyWhereItIs) {
  const Camera camera = camera_above_floor();
  PeopleBeforeCamera people(set(), camera, 0, 1);
  for (const Vector<3>& location : {Vector<3>(0, 5, 0), Vector<3>(1.5, 7, 0), Vector<3>(-2, 9, 0)}) {
    const auto truth = flat_body(location);
    const Keypoints<2> detected = observed_by(camera, truth);
    ASSERT_LT((*people.stands_at(detected) - location).norm(), 1e-3);
    const auto& located = people.step(10, {&detected, 1});
    ASSERT_EQ(located.size(), 1U);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      ASSERT_TRUE(located[0].points[i]);
      EXPECT_LT((located[0].points[i]->position - truth[i]).norm(), 2e-3) << set().points[i];
      const Vector<3> ray = (truth[i] - camera.centre()).normalized();
      EXPECT_NEAR(std::sqrt(ray.dot(located[0].points[i]->covariance * ray)), 0.2, 0.01) << "depth is not known";
      const Vector<3> across = ray.unitOrthogonal();
      EXPECT_LT(std::sqrt(across.dot(located[0].points[i]->covariance * across)), 0.03);
    }
  }
}

TEST(PeopleBeforeCamera, RejectsAFootInTheAir) {
  const Camera camera = camera_above_floor();
  const PeopleBeforeCamera people(set(), camera, 0, 1);
  const Vector<3> location(0, 5, 0);
  const auto stands = people.stands_at(observed_by(camera, flat_body(location, 0.5)));
  ASSERT_TRUE(stands);
  EXPECT_LT((*stands - location).norm(), 0.25);
}

TEST(PeopleBeforeCamera, KeepsTheNumbersOfPeopleWhoPassEachOther) {
  const Camera camera = camera_above_floor();
  PeopleBeforeCamera people(set(), camera, 0, 1);
  for (int t = 0; t < 60; ++t) {
    const double x = -1.5 + 0.05 * t;
    std::vector<Keypoints<2>> detected{observed_by(camera, flat_body({x, 5, 0})), observed_by(camera, flat_body({-x, 7, 0}))};
    if (t % 2 == 1) std::swap(detected[0], detected[1]);
    const auto& located = people.step(0.04, detected);
    ASSERT_EQ(located.size(), 2U);
    for (const LocatedPerson& person : located) {
      const bool near = person.points[0]->position.y() < 6;
      EXPECT_EQ(person.id, near ? 1 : 2) << t;
    }
  }
}

TEST(PeopleBeforeCamera, RejectsPeopleWhoseFeetAreAboveTheHorizonOrHidden) {
  const Camera camera = camera_above_floor();
  PeopleBeforeCamera people(set(), camera, 0, 1);
  std::vector<Keypoints<2>> detected{observed_by(camera, flat_body({0, 5, 0})), observed_by(camera, flat_body({0, 5, 3}))};
  for (std::size_t i = 0; i < set().points.size(); ++i) {
    const std::string& name = set().points[i];
    if (name.ends_with("ankle") || name.ends_with("heel") || name.ends_with("toe")) detected[0].points[i].reset();
  }
  EXPECT_TRUE(people.step(0, detected).empty());
}

}  // namespace
}  // namespace marey::reconstruct::keypoints
