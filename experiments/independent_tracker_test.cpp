#include "experiments/independent_tracker.h"

#include <gtest/gtest.h>

namespace marey::experiments {
namespace {

std::vector<Observation<2>> at(std::initializer_list<Vector<2>> locations) {
  std::vector<Observation<2>> detected;
  for (const Vector<2>& location : locations) detected.emplace_back().value = location;
  return detected;
}

Timestamp frame(int index) {
  return timestamp_from_seconds(index / 30.0);
}

TEST(IndependentTracker, EachTargetTakesTheNearestPointInItsOwnCircle) {
  IndependentTracker tracker(filter::AlphaBetaOptions{});
  tracker.step(frame(0), at({{100, 100}, {200, 100}}));
  const auto tracks = tracker.step(frame(1), at({{205, 100}, {110, 100}, {120, 100}}));
  ASSERT_EQ(tracks.size(), 2u);
  EXPECT_EQ(tracks[0].position, Vector<2>(110, 100));
  EXPECT_EQ(tracks[1].position, Vector<2>(205, 100));
}

TEST(IndependentTracker, TwoTargetsMayTakeTheSamePoint) {
  IndependentTracker tracker(filter::AlphaBetaOptions{});
  tracker.step(frame(0), at({{100, 100}, {110, 100}}));
  const auto tracks = tracker.step(frame(1), at({{104, 100}}));
  EXPECT_EQ(tracks[0].position, tracks[1].position);
}

TEST(IndependentTracker, WithNothingInTheCircleItCoasts) {
  IndependentTracker tracker(filter::AlphaBetaOptions{});
  tracker.step(frame(0), at({{100, 100}}));
  tracker.step(frame(1), at({{110, 100}}));
  const Vector<2> expected = tracker.expected(frame(2))[0].position;
  const auto tracks = tracker.step(frame(2), at({{300, 100}}));
  EXPECT_EQ(tracks[0].provenance, Provenance::predicted);
  EXPECT_EQ(tracks[0].position, expected);
  EXPECT_NEAR(expected.x(), 118, 1e-6) << "the velocity is 0.8 of 10 px a frame";
}

}  // namespace
}  // namespace marey::experiments
