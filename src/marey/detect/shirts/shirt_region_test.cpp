#include "marey/detect/shirts/shirt_region.h"

#include <memory>

#include <gtest/gtest.h>

#include "marey/core/keypoint_sets.h"

namespace marey::detect::shirts {
namespace {

Sample person(const Box& box) {
  Sample sample;
  sample.box = box;
  return sample;
}

void set_point(Keypoints<2>& body, const KeypointSet& set, const char* name, double x, double y, double visibility = 1) {
  body.points.resize(set.points.size());
  Keypoint<2> point;
  point.position = {x, y};
  point.visibility = visibility;
  body.points[static_cast<std::size_t>(*point_named(set, name))] = point;
}

TEST(ShirtRegion, IsInTheUpperPartOfABox) {
  const auto region = shirt_region(person({100, 50, 40, 100}), std::nullopt);
  ASSERT_TRUE(region);
  EXPECT_EQ(region->stature, 100);
  EXPECT_NEAR(region->part.centre.x(), 120, 1e-9);
  EXPECT_NEAR(region->part.centre.y(), 82, 1e-9);
  EXPECT_EQ(region->part.angle, 0);
}

TEST(ShirtRegion, FollowsTheTrunkWherePointsAreVisible) {
  const KeypointSet& set = keypoint_set_named("coco");
  Sample sample = person({0, 0, 60, 100});
  auto body = std::make_shared<Keypoints<2>>();
  set_point(*body, set, "left_shoulder", 40, 20);
  set_point(*body, set, "right_shoulder", 20, 20);
  set_point(*body, set, "left_hip", 30, 54);
  set_point(*body, set, "right_hip", 10, 54);
  sample.keypoints = body;
  const auto region = shirt_region(sample, set);
  ASSERT_TRUE(region);
  EXPECT_NEAR(region->part.centre.x(), 30 - 0.41 * 10, 1e-9);
  EXPECT_NEAR(region->part.centre.y(), 20 + 0.41 * 34, 1e-9);
  EXPECT_NEAR(region->part.angle, std::atan2(10.0, 34.0), 1e-9);
  set_point(*body, set, "left_hip", 30, 54, 0.1);
  EXPECT_EQ(shirt_region(sample, set)->part.angle, 0);  // hidden points: the box
}

TEST(ShirtRegion, IsAbsentOfWhoLiesOrBends) {
  EXPECT_FALSE(shirt_region(person({0, 0, 100, 60}), std::nullopt));
  EXPECT_FALSE(shirt_region(person({0, 0, 10, 0}), std::nullopt));
  EXPECT_FALSE(shirt_region(Sample{}, std::nullopt));
  const KeypointSet& set = keypoint_set_named("coco");
  Sample sample = person({0, 0, 60, 100});
  auto body = std::make_shared<Keypoints<2>>();
  set_point(*body, set, "left_shoulder", 60, 50);
  set_point(*body, set, "right_shoulder", 60, 60);
  set_point(*body, set, "left_hip", 20, 50);
  set_point(*body, set, "right_hip", 20, 60);
  sample.keypoints = body;
  EXPECT_FALSE(shirt_region(sample, set));
}

}  // namespace
}  // namespace marey::detect::shirts
