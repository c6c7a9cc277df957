#include "marey/detect/markers/marker_likeness.h"

#include <gtest/gtest.h>

namespace marey::detect::markers {
namespace {

using Witness = MarkerLikeness::Witness;

constexpr double kSphere = 50;  // px², of the spheres below as a threshold cuts them out

std::vector<Witness> specks(int count) {
  return {static_cast<std::size_t>(count), Witness{.radius = 0.8, .blur = 0.6, .announce = 1500, .contrast = 200, .round = true}};
}

std::vector<Witness> with_large(std::vector<Witness> detected, const std::vector<double>& radii, double contrast,
                                bool round = true) {
  for (const double radius : radii) detected.push_back({radius, {}, 1100, contrast, round});
  return detected;
}

TEST(MarkerLikeness, SpheresAmongSpecksAreAKindOfTheirOwn) {
  MarkerLikeness likeness(0);
  likeness.learn(specks(200));
  EXPECT_TRUE(likeness.odd(kSphere));
  likeness.learn(with_large(specks(200), {3.7, 3.9, 4.0, 4.2, 4.4}, 220));
  EXPECT_FALSE(likeness.odd(kSphere));
  EXPECT_TRUE(likeness.fits(4));
  EXPECT_TRUE(likeness.fits(0.8)) << "the small ones stay markers";
  EXPECT_TRUE(likeness.too_large(1000));
}

TEST(MarkerLikeness, ThingsOfAllSizesAreNoKind) {
  MarkerLikeness likeness(0);
  likeness.learn(with_large(specks(200), {2.5, 4.1, 7.0, 12.0, 16.0, 21.0}, 220));
  EXPECT_TRUE(likeness.odd(kSphere));
}

TEST(MarkerLikeness, NeitherAFewNorFaintNorLongOnesAreAKind) {
  const std::vector<double> three{4, 4, 4}, many{3.7, 3.9, 4.0, 4.2, 4.4};
  for (const auto& detected :
       {with_large(specks(200), three, 220), with_large(specks(200), many, 100), with_large(specks(200), many, 220, false)}) {
    MarkerLikeness likeness(0);
    likeness.learn(detected);
    EXPECT_TRUE(likeness.odd(kSphere));
  }
}

}  // namespace
}  // namespace marey::detect::markers
