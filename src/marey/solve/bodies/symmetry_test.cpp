#include "marey/solve/bodies/symmetry.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "marey/geometry/layout.h"
#include "marey/solve/bodies/moving_bodies_test.h"

namespace marey::solve::bodies {
namespace {

TEST(Symmetry, OfAnIsoscelesTriangleIsAHalfTurn) {
  const std::vector<Vector<3>> triangle = {{-0.1, 0, 0}, {0.1, 0, 0}, {0, 0, 0.3}};
  const auto found = symmetries(triangle, 0.005);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].onto, (std::vector<int>{1, 0, 2}));
  EXPECT_EQ(words_of(found[0]), "turned 180° about its z axis");
}

TEST(Symmetry, OfASquareAreSevenTurnsAndOfAMirroredBodyNone) {
  EXPECT_EQ(symmetries(std::vector<Vector<3>>{{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}}, 0.01).size(), 7U);
  // Each marker has its mirror image, which no turn brings it to.
  EXPECT_TRUE(symmetries(std::vector<Vector<3>>{{0.1, 0, 0}, {-0.1, 0, 0}, {0, 0.2, 0}, {0, 0.05, 0.3}}, 0.005).empty());
}

/// The slow twin: every permutation.
TEST(Symmetry, AgreesWithAllPermutationsTriedOut) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    moving::Random random(seed);
    std::vector<Vector<3>> layout;
    for (int i = 0; i < 5; ++i) {  // of few places on a grid, so that some are symmetric
      layout.push_back(
          {std::round(random.uniform(-1.4, 1.4)), std::round(random.uniform(-1.4, 1.4)), std::round(random.uniform(-0.9, 0.9))});
    }
    bool distinct = true;
    for (std::size_t a = 0; a < layout.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) distinct &= layout[a] != layout[b];
    if (!distinct) continue;
    std::vector<int> onto(layout.size());
    std::iota(onto.begin(), onto.end(), 0);
    std::vector<std::vector<int>> expected;
    while (std::next_permutation(onto.begin(), onto.end())) {
      std::vector<Vector<3>> to;
      for (const int i : onto) to.push_back(layout[static_cast<std::size_t>(i)]);
      const Rigid3 motion = geometry::rigid_fit(layout, to);
      double worst = 0;
      for (std::size_t i = 0; i < to.size(); ++i) worst = std::max(worst, (motion * layout[i] - to[i]).norm());
      if (worst < 0.01) expected.push_back(onto);
    }
    std::vector<std::vector<int>> found;
    for (const Symmetry& symmetry : symmetries(layout, 0.01)) found.push_back(symmetry.onto);
    EXPECT_EQ(found, expected) << "seed " << seed;
  }
}

}  // namespace
}  // namespace marey::solve::bodies
