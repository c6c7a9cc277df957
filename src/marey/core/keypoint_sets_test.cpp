#include "marey/core/keypoint_sets.h"

#include <set>

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey {
namespace {

TEST(KeypointSets, NameEachPointOnceAndMirrorThemInPairs) {
  for (const KeypointSet& set : keypoint_sets()) {
    SCOPED_TRACE(set.name);
    EXPECT_EQ(std::set<std::string>(set.points.begin(), set.points.end()).size(), set.points.size());
    ASSERT_EQ(set.mirrored.size(), set.points.size());
    for (int i = 0; i < std::ssize(set.points); ++i) {
      const std::string& name = set.points[static_cast<std::size_t>(i)];
      const int other = set.mirrored[static_cast<std::size_t>(i)];
      EXPECT_EQ(set.mirrored[static_cast<std::size_t>(other)], i);
      EXPECT_EQ(other != i, name.starts_with("left_") || name.starts_with("right_")) << name;
      EXPECT_EQ(common_keypoint_name(name), name);
    }
    std::set<int> connected;
    for (const auto& [a, b] : set.bones) connected.insert({a, b});
    EXPECT_EQ(connected.size(), set.points.size()) << "each point is at a bone";
  }
}

TEST(KeypointSets, HaveTheOrderOfTheProgramsThatWriteThem) {
  const auto expect = [](const char* name, std::size_t size, int index, const char* point) {
    const KeypointSet& set = keypoint_set_named(name);
    EXPECT_EQ(set.points.size(), size);
    EXPECT_EQ(set.points[static_cast<std::size_t>(index)], point);
  };
  expect("body_25", 25, 8, "mid_hip");
  expect("body_25", 25, 24, "right_heel");
  expect("body_25b", 25, 17, "upper_neck");
  expect("coco_18", 18, 1, "neck");
  expect("coco", 17, 16, "right_ankle");
  expect("halpe_26", 26, 20, "left_big_toe");
  expect("blazepose", 33, 25, "left_knee");
  EXPECT_THROW(keypoint_set_named("body_26"), Error);
}

TEST(KeypointSets, UnderstandOtherSpellings) {
  for (const char* name : {"LKnee", "l_knee", "left-knee", "knee_left", "Left Knee", "LEFT_KNEE"})
    EXPECT_EQ(common_keypoint_name(name), "left_knee") << name;
  EXPECT_EQ(common_keypoint_name("RBigToe"), "right_big_toe");
  EXPECT_EQ(common_keypoint_name("right_foot_index"), "right_big_toe");
  EXPECT_EQ(common_keypoint_name("Head"), "head_top");
  EXPECT_EQ(common_keypoint_name("snout"), "snout");
}

}  // namespace
}  // namespace marey
