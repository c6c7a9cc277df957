#include "marey/calibrate/people/people_world.h"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "marey/core/keypoint_sets.h"

namespace marey::calibrate::people {
namespace {

/// A person who stands here and there on a floor that is neither level nor at the origin.
TEST(PeopleWorld, PutsTheFloorBelowTheFeet) {
  const KeypointSet& set = keypoint_set_named("coco");
  Rigid3 tilted;
  tilted.rotation = Eigen::AngleAxisd(0.9, Vector<3>(1, 2, -0.5).normalized()).toRotationMatrix();
  tilted.translation = {3, -2, 7};
  const double scale = 0.4, stature = 1.8;
  std::vector<Body3> bodies;
  for (int k = 0; k < 60; ++k) {
    Body3 body{0, k / 25.0, std::vector<std::optional<Vector<3>>>(set.points.size())};
    const Vector<3> foot(2 * std::cos(0.3 * k), 1.5 * std::sin(0.2 * k), 0);
    const auto put = [&](const char* name, double side, double height) {
      const Vector<3> at = foot + Vector<3>(side + 0.02 * std::sin(3.0 * k), 0.02 * std::cos(5.0 * k), height * stature);
      body.points[static_cast<std::size_t>(point_named(set, name).value())] = scale * (tilted * at);
    };
    put("left_ankle", -0.1, k % 2 == 0 ? 0.039 : 0.15), put("right_ankle", 0.1, k % 2 == 0 ? 0.15 : 0.039);
    put("left_shoulder", -0.2, 0.818), put("right_shoulder", 0.2, 0.818);
    put("left_eye", -0.03, 0.936), put("right_eye", 0.03, 0.936);
    bodies.push_back(body);
  }
  const auto world = world_of(bodies, set);
  ASSERT_TRUE(world);
  EXPECT_NEAR(world->height / scale, stature, 0.15) << "one foot is lifted";
  const Matrix<3> upright = world->moved_from_world.rotation * tilted.rotation;
  EXPECT_GT(upright(2, 2), std::cos(0.01));
  const Vector<3> sole = world->moved_from_world * Vector<3>(scale * (tilted * Vector<3>(1, 0, 0)));
  EXPECT_NEAR(sole.z() / scale, 0, 0.03);
}

}  // namespace
}  // namespace marey::calibrate::people
