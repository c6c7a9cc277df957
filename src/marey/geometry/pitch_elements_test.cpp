#include "marey/geometry/pitch_elements.h"

#include <algorithm>
#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace marey::geometry {
namespace {

constexpr PitchMirror kEvery[] = {{}, {.left_right = true}, {.near_far = true}, {.left_right = true, .near_far = true}};

double farthest(const std::vector<Vector<3>>& points, const std::vector<Vector<3>>& from) {
  double farthest = 0;
  for (const Vector<3>& point : points) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector<3>& other : from) nearest = std::min(nearest, (point - other).norm());
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

TEST(PitchElements, AreFoundByTheirNames) {
  const auto all = pitch_elements({});
  for (int i = 0; i < kPitchElements; ++i) EXPECT_EQ(pitch_element_named(all[i].name), i) << all[i].name;
  EXPECT_TRUE(pitch_element_named("Goal left post left"));  // its blank is forgotten easily
  EXPECT_FALSE(pitch_element_named("Side line"));
  EXPECT_FALSE(pitch_element_named(""));
}

TEST(PitchElements, GroundElementsAreLinesOfThePitch) {
  const PitchSize size{101, 66};
  for (const PitchElement& element : pitch_elements(size)) {
    if (element.name.starts_with("Goal")) continue;
    for (const Vector<3>& point : sampled(element, 0.5)) {
      EXPECT_LT(distance_to_line(size, point.head<2>()), 1e-9) << element.name;
      EXPECT_EQ(point.z(), 0) << element.name;
    }
  }
}

TEST(PitchElements, MirroredOneLiesWhereTheMirrorPutsIt) {
  const PitchSize size{101, 66};
  const auto all = pitch_elements(size);
  for (const PitchMirror mirror : kEvery) {
    for (int i = 0; i < kPitchElements; ++i) {
      std::vector<Vector<3>> reflected = sampled(all[i], 0.1);
      for (Vector<3>& point : reflected) {
        if (mirror.left_right) point.x() = size.length - point.x();
        if (mirror.near_far) point.y() = size.width - point.y();
      }
      const int other = mirrored_element(i, mirror);
      EXPECT_LT(farthest(reflected, sampled(all[other], 0.1)), 0.11) << all[i].name << " and " << all[other].name;
      EXPECT_EQ(mirrored_element(other, mirror), i);
    }
  }
}

}  // namespace
}  // namespace marey::geometry
