#include "marey/pipeline/bodies/same_person.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "marey/filter/random_stream.h"

namespace marey::pipeline::bodies {
namespace {

using solve::skeleton::ObservedMarkers;

/// Five markers on each of two segments.
Skeleton two_segments() {
  Skeleton skeleton;
  skeleton.segments.resize(2);
  for (int m = 0; m < 10; ++m) {
    SkeletonMarker& marker = skeleton.markers.emplace_back();
    marker.label = std::string(1, static_cast<char>('A' + m));
    marker.segment = m / 5;
  }
  return skeleton;
}

std::vector<Vector<3>> layout() {
  filter::RandomStream random(3);
  std::vector<Vector<3>> places;
  for (int m = 0; m < 10; ++m) places.push_back(0.4 * Vector<3>(random.uniform(), random.uniform(), random.uniform()));
  return places;
}

/// The markers in 20 frames with 2 mm of noise, each segment at another place in each, one frame in four without marker B.
std::vector<ObservedMarkers> observed(const std::vector<Vector<3>>& places, std::uint64_t seed) {
  filter::RandomStream random(seed);
  std::vector<ObservedMarkers> frames;
  for (int f = 0; f < 20; ++f) {
    ObservedMarkers& frame = frames.emplace_back();
    for (std::size_t m = 0; m < places.size(); ++m) {
      const double angle = 0.2 * f * (m < 5 ? 1 : -2);
      const Vector<3> turned(std::cos(angle) * places[m].x() - std::sin(angle) * places[m].y(),
                             std::sin(angle) * places[m].x() + std::cos(angle) * places[m].y(), places[m].z() + 0.1 * f);
      const auto [x, y] = random.normal_pair();
      frame.push_back(turned + 0.002 * Vector<3>(x, y, random.normal_pair().first));
    }
    if (f % 4 == 0) frame[1].reset();
  }
  return frames;
}

TEST(SamePerson, AgreesWithItself) {
  const auto here = observed(layout(), 1), there = observed(layout(), 2);
  EXPECT_EQ(other_size(two_segments(), here, there), std::nullopt);
  EXPECT_TRUE(moved_markers(two_segments(), here, there).empty());
  EXPECT_TRUE(moved_markers(two_segments(), here, {}).empty()) << "no pair is in both";
}

TEST(SamePerson, FindsTheMarkersThatWerePutOnAgain) {
  auto moved = layout();
  moved[3] += Vector<3>(0.03, 0.02, 0.03);
  moved[7] += Vector<3>(-0.05, 0.02, 0);
  const auto here = observed(layout(), 1), there = observed(moved, 2);
  const auto differs = other_size(two_segments(), here, there);
  ASSERT_TRUE(differs);
  EXPECT_TRUE(differs->find('D') != std::string::npos || differs->find('H') != std::string::npos) << *differs;
  auto found = moved_markers(two_segments(), here, there);
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, (std::vector<std::size_t>{3, 7}));
}

TEST(SamePerson, AnotherPersonHasMostOfThemElsewhere) {
  auto taller = layout();
  for (Vector<3>& place : taller) place *= 1.25;
  EXPECT_GE(moved_markers(two_segments(), observed(layout(), 1), observed(taller, 2)).size(), 4U);
}

}  // namespace
}  // namespace marey::pipeline::bodies
