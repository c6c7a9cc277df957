#include "marey/solve/bodies/body_initialisation.h"

#include <vector>

#include <gtest/gtest.h>

#include "marey/solve/bodies/moving_bodies_test.h"

namespace marey::solve::bodies {
namespace {

constexpr double kWithin_m = 0.005;

/// The layout somewhere in space; mirrored where asked for.
std::vector<Vector<3>> located(const std::vector<Vector<3>>& layout, bool mirrored, moving::Random& random) {
  const geometry::Rigid3 pose{geometry::rotation_from(random.in_box(2)), random.in_box(1)};
  std::vector<Vector<3>> points;
  for (const Vector<3>& marker : layout)
    points.push_back(pose * Vector<3>(mirrored ? -marker.x() : marker.x(), marker.y(), marker.z()));
  return points;
}

TEST(BodyInitialiser, FindsABodyAndNotItsMirrorImage) {
  int found = 0, mirrored = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    moving::Random random(seed);
    const std::vector<Vector<3>> layout = moving::scattered(random, 5, 0.12, 0.05);
    BodyInitialiser initialise({layout}, kWithin_m);
    const int required[] = {0};
    found += !initialise.find(located(layout, false, random), required).empty();
    for (const PoseCandidate& candidate : initialise.find(located(layout, true, random), required)) {
      EXPECT_EQ(candidate.matched, 5) << "its mirror image must be the body itself within the tolerance";
      ++mirrored;
    }
  }
  EXPECT_EQ(found, 100);
  EXPECT_LE(mirrored, 5) << "of scattered markers few are almost their mirror image";
}

TEST(BodyInitialiser, FindsABodyOfWhichAMarkerIsHidden) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    moving::Random random(seed);
    const std::vector<Vector<3>> layout = moving::scattered(random, 5, 0.12, 0.05);
    BodyInitialiser initialise({layout}, kWithin_m);
    std::vector<Vector<3>> points = located(layout, false, random);
    points.erase(points.begin() + static_cast<std::ptrdiff_t>(seed % 5));
    const int required[] = {0};
    found += !initialise.find(points, required).empty();
  }
  EXPECT_EQ(found, 100);
}

}  // namespace
}  // namespace marey::solve::bodies
